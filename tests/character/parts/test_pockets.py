"""Hands at the hips and before the belly that were not found: whether they are hidden, what is theirs, and what happens as they come out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from benchmarks.character_figures.steps import wake
from benchmarks.known_truth.dressed_template import Look, Turns, dress
from benchmarks.known_truth.known_person import draw_into
from benchmarks.known_truth.known_places import places
from engine.body.shape import Phenotype
from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import Silhouette
from engine.character.fit.template_fit import FittedBody
from engine.character.options import CharacterOptions, LabelStroke
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import ARM_LABELS, BODY_PARTS
from engine.character.parts.pockets import parted, with_hand_parted
from engine.character.parts.unfound_hands import UnfoundHand, unfound_hands
from engine.character.pipeline import cut_all_out, find_figures, reconstruct
from engine.character.rig.measures import pose
from engine.character.rig.rigging import Character
from engine.character.stages import fit_template, label
from engine.geometry.mesh.welding import weld
from engine.media.limits import Limits
from engine.motion.edit import in_place
from engine.motion.library import built_in
from engine.perception.pose.body import BODY_LANDMARKS
from engine.run import Run

SHAPE = (160, 120)
LEFT, TORSO, LEG = (BODY_PARTS.index(name) for name in ("left_arm", "torso", "left_leg"))
SKIN, SLEEVE, CLOTH = (205, 150, 130), (60, 70, 160), (60, 120, 60)

STANDING = {
    **{"LeftShoulder": (75, 30), "RightShoulder": (45, 30), "LeftHip": (68, 90), "RightHip": (52, 90)},
    **{"LeftWrist": (85, 88), "LeftIndex": (84, 100), "LeftPinky": (86, 100)},
    **{"RightWrist": (35, 88), "RightIndex": (34, 100), "RightPinky": (36, 100)},
}
FACE = np.array([[50, 5, 0], [70, 5, 0], [70, 25, 0], [50, 25, 0]], np.float32)
ON_GRID = np.array([[1.0, 0, 0], [0, 1, 0]])


def figure(
    places: dict[str, tuple[float, float]], face: bool = True, left_hand: bool = False, sure: float = 0.6
) -> Figure:
    points, none = np.zeros((len(BODY_LANDMARKS), 2), np.float32), np.zeros(SHAPE, np.bool_)
    for name, place in (STANDING | places).items():
        points[BODY_LANDMARKS.index(name)] = place
    confidence = np.full(len(BODY_LANDMARKS), sure, np.float32)
    hands = (np.zeros((21, 3), np.float32) if left_hand else None, None)
    return Figure(np.zeros((*SHAPE, 3), np.uint8), None, points, confidence, np.zeros((len(BODY_LANDMARKS), 3), np.float32), True,
                  SHAPE[::-1], np.zeros((1, 4), np.float32), 0, none, FACE if face else None, hands)  # fmt: skip


def test_hands_are_looked_for_at_their_hips() -> None:
    def arms(seen: Figure) -> tuple[int, ...]:
        return tuple(hand.arm for hand in unfound_hands(seen, seen.rgb, ON_GRID))

    assert arms(figure({})) == ARM_LABELS
    assert arms(figure({}, sure=0.95)) == ARM_LABELS, "it may be too small to be known for a hand"
    assert arms(figure({}, left_hand=True)) == ARM_LABELS[1:]
    assert arms(figure({"LeftWrist": (90, 50)})) == ARM_LABELS[1:], "raised"
    assert arms(figure({"LeftWrist": (118, 88)})) == ARM_LABELS[1:], "far from the hip"
    (left, _) = unfound_hands(figure({}), figure({}).rgb, ON_GRID)
    np.testing.assert_array_equal(left.wrist, [85, 88])
    np.testing.assert_array_equal(left.knuckles, [85, 100])
    assert left.confidence == pytest.approx(0.6) and not left.before and len(left.skin) > 100


def test_and_before_the_belly_if_nobody_sees_them() -> None:
    before = {"LeftWrist": (62, 88)}
    left, right = unfound_hands(figure(before), figure(before).rgb, ON_GRID)
    assert left.before and not right.before
    sure = figure(before, sure=0.95)
    assert [hand.arm for hand in unfound_hands(sure, sure.rgb, ON_GRID)] == [ARM_LABELS[1]]
    joined = figure({"LeftWrist": (62, 88), "RightWrist": (57, 88)})
    assert unfound_hands(joined, joined.rgb, ON_GRID) == (), "one may hide the other"


def test_without_a_face_nothing_is_known_of_skin() -> None:
    seen = figure({}, face=False)
    assert [len(hand.skin) for hand in unfound_hands(seen, seen.rgb, ON_GRID)] == [0, 0]


def noisy(colour: tuple[int, int, int], shape: tuple[int, ...]) -> np.ndarray:
    noise = np.random.default_rng(1).normal(0, 4, (*shape, 3))
    return np.clip(np.array(colour) + noise, 0, 255)


def standing(hand_shown: bool, arm_labelled_to: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, UnfoundHand]:
    """A picture of cloth with a sleeve before it as far as row 100, below which the template's hand is, from 104 to 130;
    labels in which the arm goes on to some row; that hand; and what is known of it."""
    rgb, labels, template = noisy(CLOTH, SHAPE), np.full(SHAPE, TORSO), np.zeros(SHAPE, np.bool_)
    rgb[:100, 80:100] = noisy(SLEEVE, (100, 20))
    labels[100:], labels[:arm_labelled_to, 80:100] = LEG, LEFT
    template[100:130, 82:98] = True
    if hand_shown:
        rgb[100:130, 82:98] = noisy(SKIN, (30, 16))
    skin = noisy(SKIN, (400,))
    return (
        rgb.astype(np.uint8),
        labels,
        template,
        UnfoundHand(LEFT, np.array([90.0, 100]), np.array([90.0, 115]), 0.8, False, skin),
    )


def test_a_hand_in_a_pocket_leaves_the_cloth_to_the_leg() -> None:
    rgb, labels, template, hand = standing(hand_shown=False, arm_labelled_to=120)
    found = parted(rgb, labels, template, hand)
    assert found is not None
    after = with_hand_parted(labels, found, LEFT)
    np.testing.assert_array_equal(after[:98] == LEFT, labels[:98] == LEFT)
    assert (after[103:] == LEG).all()
    np.testing.assert_array_equal(found.hidden[103:], template[103:])
    assert not (found.hidden & (after == LEFT)).any()


def test_a_hand_whose_skin_is_seen_is_the_arms() -> None:
    rgb, labels, template, hand = standing(hand_shown=True, arm_labelled_to=100)
    found = parted(rgb, labels, template, hand)
    assert found is not None
    after = with_hand_parted(labels, found, LEFT)
    assert (after == LEFT)[102:128, 84:96].all()
    assert ((after == LEFT) & (labels != LEFT) & ~template).sum() < 0.15 * template.sum(), "its edge at most"
    assert not found.hidden.any()


def greyed(rgb: np.ndarray, hand: UnfoundHand) -> tuple[np.ndarray, UnfoundHand]:
    grey = np.repeat(rgb.mean(-1, keepdims=True), 3, -1).astype(np.uint8)
    return grey, replace(hand, skin=np.repeat(hand.skin.mean(-1, keepdims=True), 3, -1))


def test_without_colours_a_hand_is_hidden_where_the_cloth_goes_on() -> None:
    rgb, labels, template, hand = standing(hand_shown=False, arm_labelled_to=120)
    grey, hand = greyed(rgb, hand)
    found = parted(grey, labels, template, hand)
    assert found is not None
    assert (with_hand_parted(labels, found, LEFT)[106:] == LEG).all()
    np.testing.assert_array_equal(found.hidden[106:], template[106:])
    assert parted(grey, labels, template, replace(hand, confidence=0.95)) is None, "its fingers are seen"


def test_without_colours_nothing_is_said_of_a_hand_that_stands_out() -> None:
    rgb, labels, template, hand = standing(hand_shown=True, arm_labelled_to=100)
    grey, hand = greyed(rgb, hand)
    assert parted(grey, labels, template, hand) is None
    assert parted(grey, labels, template, replace(hand, confidence=0.3)) is None


def test_cloth_of_the_skins_hue_hides_a_hand_too() -> None:
    """Beige trousers, and a sleeve of another colour."""
    rgb, labels, template, hand = standing(hand_shown=False, arm_labelled_to=120)
    rgb[(labels == LEG) | (labels == TORSO)] = noisy(SKIN, (int(((labels == LEG) | (labels == TORSO)).sum()),))
    rgb[100:120, 80:100] = noisy(SKIN, (20, 20))
    found = parted(rgb, labels, template, hand)
    assert found is not None and found.hidden.any()
    assert (with_hand_parted(labels, found, LEFT)[106:] == LEG).all()


def test_in_the_pocket_of_a_jumper_a_hand_ends_at_its_cuff() -> None:
    """Sleeve and pocket are one cloth."""
    rgb, labels, template, hand = standing(hand_shown=False, arm_labelled_to=120)
    rgb[:] = noisy(SLEEVE, SHAPE)
    found = parted(rgb.astype(np.uint8), labels, template, replace(hand, before=True))
    assert found is not None
    after = with_hand_parted(labels, found, LEFT)
    assert (after[112:] != LEFT).all() and (after[:100, 82:98] == LEFT).all()
    shown = standing(hand_shown=True, arm_labelled_to=120)[0]
    assert parted(shown, labels, template, replace(hand, before=True)) is None, "what is seen there is left as it is"


def test_of_a_hand_beside_the_person_nothing_is_said() -> None:
    rgb, labels, template, hand = standing(hand_shown=True, arm_labelled_to=100)
    assert parted(rgb, np.where(template, -1, labels), template, hand) is None


def test_a_hidden_hand_comes_out_and_the_cloth_stays(media: Callable[[str], Path]) -> None:
    """And the report tells that it is made up. A stroke of the user's over it overrules that."""
    options = CharacterOptions(triangles=20_000)
    with Run() as run:
        (figure,) = find_figures(media("fullbody/woman_green_dress_hip.jpg"), options, run)
        (figure,), (silhouette,) = cut_all_out([figure], None, options, run)
        person = reconstruct(figure, silhouette, None, options, run)
    hidden = person.labels.hidden
    assert set(np.unique(hidden)) == {-1, LEFT}
    assert "hand_in_pocket" in [notice.code for notice in run.notices]
    comes_out(person.character, "Left")

    y, x = np.argwhere(hidden >= 0).mean(axis=0)
    to_grid = silhouette.to_grid
    place = np.linalg.solve(to_grid[:, :2], np.array([x, y]) - to_grid[:, 2]) / figure.scale
    stroke = LabelStroke(path=((float(place[0]), float(place[1])),), radius=0.05 * figure.rgb.shape[0], part="left_arm")
    painted = labelled(figure, silhouette, person.fitted, (stroke,))
    assert painted.labels[round(y), round(x)] == LEFT
    assert (painted.hidden >= 0).sum() < 0.1 * (hidden >= 0).sum()


def labelled(
    figure: Figure, silhouette: Silhouette, fitted: FittedBody, strokes: tuple[LabelStroke, ...] = ()
) -> Labels:
    return label(figure, silhouette, fitted, None, strokes, Limits(), lambda code, message: None)


def test_hands_that_are_seen_are_not_made_up(media: Callable[[str], Path]) -> None:
    options = CharacterOptions()
    with Run() as run:
        figures = find_figures(media("fullbody/iper_apose_1.jpg"), options, run)
        (figure,), (silhouette,) = cut_all_out(figures, None, options, run)
    assert (labelled(figure, silhouette, fit_template(figure, silhouette)).hidden == -1).all()


IN_TROUSERS: Turns = {
    **{"LeftArm": (57, 13, -59), "LeftForeArm": (0, -70, -6), "LeftHand": (3, 23, -2)},
    **{"RightArm": (57, -13, 59), "RightForeArm": (0, 70, 6), "RightHand": (3, -23, 2)},
}
IN_A_JUMPER: Turns = {
    **{"LeftArm": (-33, 10, -56), "LeftForeArm": (0, 0, -96), "LeftHand": (9, 61, -13)},
    **{"RightArm": (-33, -10, 56), "RightForeArm": (0, 0, 96), "RightHand": (9, -61, 13)},
}
BEIGE = (205, 172, 142)
SMALL = (640, 480)
"""(height, width) of the drawn pictures."""


@pytest.mark.parametrize(
    ("turns", "trousers", "grey"),
    [(IN_TROUSERS, BEIGE, False), (IN_A_JUMPER, BEIGE, True)],
    ids=["trousers of the skin's colour", "a jumper's pocket, no colours"],
)
def test_both_hands_come_out_of_pockets(
    turns: Turns, trousers: tuple[int, int, int], grey: bool, tmp_path: Path
) -> None:
    """The dressed template, its hands within the body."""
    look = Look("hands in pockets", Phenotype(gender=0.5), turns, (120, 60, 60), trousers)
    rgb = draw_into(dress(look), places(SMALL)["street"]).rgb
    if grey:
        rgb = np.repeat(cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY)[..., None], 3, 2)
    photo = tmp_path / "photo.png"
    cv2.imwrite(str(photo), rgb[..., ::-1])
    woken = wake(photo, {"triangles": 20_000})
    assert set(np.unique(woken.labels.hidden)) == {-1, *ARM_LABELS}
    for side in ("Left", "Right"):
        comes_out(woken.character, side)


def comes_out(character: Character, side: str) -> None:
    """A hand that was hidden is joined to no cloth around it, comes out where the arm is raised, and leaves the cloth."""
    mesh, names = character.mesh, character.mesh.skeleton.names
    point = weld(mesh)
    ends = np.sort(point[mesh.triangles][:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), 1)
    edges = np.unique(ends, axis=0)
    count = point.max() + 1
    _, piece = connected_components(csr_matrix((np.ones(len(edges)), edges.T), (count, count)))
    most = mesh.bones[np.arange(len(point)), mesh.weights.argmax(1)]
    hand = np.array([bone.startswith(f"{side}Hand") for bone in names])[most]
    below = np.array([bone.startswith(("Hips", "LeftUpLeg", "RightUpLeg", "LeftLeg", "RightLeg")) for bone in names])[
        most
    ]
    assert hand.sum() > 100
    assert not set(piece[point[hand]]) & set(piece[point[below]]), "no edge leads from the hand to the cloth"

    still = pose(character, character.pictured)
    clip = in_place(built_in("dance", mesh.skeleton))
    raised = pose(character, clip, int(0.6 * len(clip.rotations)))
    assert np.median(raised[hand, 1] - still[hand, 1]) > 0.4, "both arms are up in the dance"
    middle = np.median(still[hand], axis=0)
    pocket = below & (np.linalg.norm(still - middle, axis=1) < 0.15)
    assert pocket.sum() > 20
    assert np.median(raised[pocket, 1] - still[pocket, 1]) < 0.1

    wave = in_place(built_in("wave", mesh.skeleton))
    first = np.unique(point, return_index=True)[1]
    a, b = first[edges].T
    length = np.maximum(np.linalg.norm(still[a] - still[b], axis=1), 1e-4)
    for frame in range(0, len(wave.rotations), 10):
        posed = pose(character, wave, frame)
        assert (np.linalg.norm(posed[a] - posed[b], axis=1) > 3 * length).mean() < 0.005
