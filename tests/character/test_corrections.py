"""What users correct: who is meant, the mask, the labels, the back; and what is said of postures and wrong files."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from pydantic import ValidationError

from engine.body.parts import BODY_PARTS
from engine.character.figure.figure import Choice, Figure, find_figure
from engine.character.figure.posture import check_posture
from engine.character.figure.silhouette import Silhouette, cut_out
from engine.character.figure.strokes import LABEL_COLOURS, read_labels, read_mask, repaint_mask
from engine.character.fit.template_fit import fit_figure, load_human, pose_template
from engine.character.options import CharacterOptions, LabelStroke, MaskStroke
from engine.character.parts.label_map import Labels
from engine.character.pipeline import cut_all_out, find_figures, wake_up
from engine.character.sample import sample_picture
from engine.character.stages import fit_template, label
from engine.character.texture.limb_texture import LimbSurfaces
from engine.character.texture.texture import PictureOnGrid, paint_tiles
from engine.errors import InputError
from engine.media.image import read_image, write_image
from engine.media.limits import Limits
from engine.perception.pose.body import BODY_LANDMARKS
from engine.perception.pose.people import MAX_DETECTED_PEOPLE, find_people, person_box
from engine.run import Run

LIMITS = Limits()


def quiet(code: str, message: str) -> None:
    """A warning that is not looked at."""


def found(path: Path, choice: Choice, warnings: list[str] | None = None, partial: bool = False) -> Figure:
    told = [] if warnings is None else warnings
    return find_figure(path, choice, partial, LIMITS, lambda code, message: told.append(code))


def outlined(figure: Figure, mask: Path | None = None, warnings: list[str] | None = None) -> Silhouette:
    told = [] if warnings is None else warnings
    return cut_out(figure, mask, (), LIMITS, None, None, lambda code, message: told.append(code))


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("alone") / "photo.png"
    write_image(path, sample_picture())
    return path


@pytest.fixture(scope="module")
def couple(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two people beside one another, the right one smaller."""
    one = sample_picture()
    small = cv2.resize(one, None, fx=0.7, fy=0.7, interpolation=cv2.INTER_AREA)
    wall = np.full((one.shape[0], small.shape[1], 3), one[2, 2], np.uint8)
    wall[-small.shape[0] :] = small
    path = tmp_path_factory.mktemp("couple") / "photo.png"
    write_image(path, np.concatenate([one, wall], 1))
    return path


@pytest.fixture(scope="module")
def figure(alone: Path) -> Figure:
    return found(alone, Choice())


@pytest.fixture(scope="module")
def silhouette(figure: Figure) -> Silhouette:
    return outlined(figure)


@pytest.fixture(scope="module")
def labels(figure: Figure, silhouette: Silhouette) -> Labels:
    return label(figure, silhouette, fit_template(figure, silhouette), None, (), LIMITS, quiet)


def test_of_two_people_the_larger_is_meant_unless_said_otherwise(couple: Path) -> None:
    first, second = found(couple, Choice()), found(couple, Choice(index=1))
    width = first.rgb.shape[1]
    assert len(first.people) == 2 and (first.index, second.index) == (0, 1)
    assert first.point("Nose")[0] < 0.5 * width < second.point("Nose")[0]
    for box, figure in zip(first.people, (first, second), strict=True):
        x, y = figure.point("Nose")
        assert box[0] < x < box[0] + box[2] and box[1] < y < box[1] + box[3]


def test_a_box_says_who_is_meant(couple: Path) -> None:
    x, y, wide, high = (float(value) for value in found(couple, Choice()).people[1])
    figure = found(couple, Choice(box=(x, y, wide, high)))
    assert figure.index == 1
    np.testing.assert_array_equal(found(couple, Choice((x, y, wide, high), 0)).points, figure.points)
    alpha = outlined(figure).alpha
    assert alpha[:, : int(x - 0.3 * wide)].max() < 0.5, "the other one is not in the mask"
    assert (alpha > 0.5).sum() > 0.2 * wide * high


def cut_from_grey(path: Path) -> np.ndarray:
    """A person rendered before plain grey, cut out: (h, w, 4) float32."""
    rgb = read_image(path).rgb
    differs = (np.abs(rgb.astype(int) - rgb[5, 5]).max(2) > 10).astype(np.uint8)
    closed = cv2.morphologyEx(differs, cv2.MORPH_CLOSE, np.ones((7, 7), np.uint8))
    outlines, _ = cv2.findContours(closed, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    largest = max(outlines, key=cv2.contourArea)
    x, y, wide, high = cv2.boundingRect(largest)
    alpha = cv2.GaussianBlur(cv2.drawContours(np.zeros(rgb.shape[:2], np.float32), [largest], -1, 1, -1), (0, 0), 0.8)
    return np.dstack([rgb, alpha])[y : y + high, x : x + wide].astype(np.float32)


def test_of_transparent_people_each_is_cut_out_alone(media: Callable[[str], Path], tmp_path: Path) -> None:
    """The second stands before the first's arm; their outlines stay the picture's own."""
    first, second = (cut_from_grey(media(f"fullbody/scan_render_{name}.jpg")) for name in ("lee_suit", "corey_wave"))
    height, left = max(len(first), len(second)), first.shape[1] - 40
    rgb, truth = np.full((height, left + second.shape[1], 3), 200, np.float32), []
    for cut, x in ((first, 0), (second, left)):
        there = np.zeros(rgb.shape[:2], np.float32)
        part = np.s_[height - len(cut) :, x : x + cut.shape[1]]
        there[part] = cut[..., 3]
        rgb[part] += cut[..., 3:] * (cut[..., :3] - rgb[part])
        truth = [*(before * (1 - there) for before in truth), there]
    write_image(tmp_path / "photo.png", rgb.astype(np.uint8), np.clip(sum(truth), 0, 1))
    for index in (0, 1):
        figure = found(tmp_path / "photo.png", Choice(index=index))
        mask = outlined(figure).alpha > 0.5
        true = truth[int(figure.point("Nose")[0] > left)] > 0.5
        assert len(figure.people) == 2
        assert (mask & true).sum() > 0.96 * (mask | true).sum()


def test_who_is_not_there_cannot_be_meant(couple: Path) -> None:
    for choice, code in (
        (Choice(index=2), "person_index_out_of_range"),
        (Choice(box=(-500, 0, 100, 100)), "person_box_outside"),
        (Choice(box=(0, 0, 30, 30)), "no_person"),
    ):
        with pytest.raises(InputError) as raised:
            found(couple, choice)
        assert raised.value.code == code
        assert "person_box" in raised.value.correctable


@pytest.mark.parametrize("box", [(10, 10, 0, 50), (10, 10, 50, 0), (400, 500, -300, -400)])
def test_a_box_without_an_area_is_no_option(box: tuple[float, float, float, float]) -> None:
    with pytest.raises(ValidationError):
        CharacterOptions(person_box=box)


def test_in_a_crowd_it_must_be_said_who_is_meant(tmp_path: Path) -> None:
    """Of more people than are looked for, one who is not among those found is one of them once a box says so, and is cut
    out there."""
    one = cv2.resize(sample_picture(), None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
    wide, high = one.shape[1], one.shape[0]
    write_image(tmp_path / "crowd.png", np.concatenate([one] * (MAX_DETECTED_PEOPLE + 1), 1))
    with pytest.raises(InputError) as raised:
        found(tmp_path / "crowd.png", Choice())
    assert (raised.value.code, raised.value.correctable) == ("crowd", ("person_index", "person_box"))
    people = raised.value.found["people"]
    largest = found(tmp_path / "crowd.png", Choice(index=0))
    assert (largest.index, len(largest.people)) == (0, len(people))
    seen = {int((x + across / 2) // wide) for x, _, across, _ in people}
    left = min(set(range(MAX_DETECTED_PEOPLE + 1)) - seen) * wide
    figure = found(tmp_path / "crowd.png", Choice(box=(left, 0, wide, high)))
    assert len(figure.people) == len(people) + 1 and figure.index == len(people)
    columns = np.flatnonzero((outlined(figure).alpha > 0.5).any(0)) / figure.scale[0]
    assert left < columns[0] and columns[-1] < left + wide


def test_an_arm_dragged_aside_is_fitted_there(alone: Path, figure: Figure) -> None:
    """What perception believed of it in space does not hold against it."""
    human = load_human()
    shoulder, hip = figure.point("LeftShoulder"), figure.point("LeftHip")
    arm = float(np.linalg.norm(hip - shoulder)) * 0.5
    elbow, wrist = (np.add(shoulder, (share * arm, 0)) for share in (1, 2))
    placed = (("LeftElbow", *map(float, elbow)), ("LeftWrist", *map(float, wrist)))
    dragged = found(alone, Choice(placed=placed))
    mask = outlined(figure).alpha > 0.5
    fitted = fit_figure(dragged, mask)
    posed = pose_template(fitted, fitted.picture_camera(), human)
    at = posed.joints[human.rig.index("LeftForeArm"), :2]
    assert np.linalg.norm(at - elbow) < 0.35 * arm


def test_one_person_is_one_person(media: Callable[[str], Path]) -> None:
    for name in ("biden_arms_crossed_3q.jpg", "woman_grey_skirt.jpg"):
        rgb = cv2.imread(str(media(f"fullbody/{name}")))[..., ::-1]
        people = find_people(np.ascontiguousarray(rgb))
        assert len(people) == 1
        assert person_box(people[0], rgb.shape)[3] > 0.8 * len(rgb)


def test_strokes_have_the_last_word_over_the_mask(figure: Figure, silhouette: Silhouette) -> None:
    belly, wall = (
        figure.points[[BODY_LANDMARKS.index("LeftHip"), BODY_LANDMARKS.index("RightHip")]].mean(0),
        (30.0, 30.0),
    )
    at = (float(belly[0]), float(belly[1]))
    painted = repaint_mask(
        silhouette.alpha,
        (MaskStroke(path=(at,), radius=8, person=False), MaskStroke(path=(wall,), radius=5, person=True)),
        figure.scale,
    )
    assert silhouette.alpha[round(at[1]), round(at[0])] == 1 and painted[round(at[1]), round(at[0])] == 0
    assert painted[30, 30] == 1 and silhouette.alpha[30, 30] < 0.5
    changed = np.abs(painted - silhouette.alpha) > 0.5
    assert abs(changed.sum() - np.pi * (8**2 + 5**2)) < 0.2 * np.pi * (8**2 + 5**2)


def test_a_mask_that_is_given_back_is_the_mask(figure: Figure, silhouette: Silhouette, tmp_path: Path) -> None:
    write_image(tmp_path / "mask.png", np.repeat(np.round(silhouette.alpha * 255).astype(np.uint8)[..., None], 3, 2))
    again = outlined(figure, tmp_path / "mask.png")
    np.testing.assert_allclose(again.alpha, silhouette.alpha, atol=0.01)
    assert (again.mask != silhouette.mask).mean() < 1e-3


def test_of_a_mask_in_pieces_the_one_with_the_joints_is_the_person(couple: Path, tmp_path: Path) -> None:
    """The mask shows both people; it is meant to be the smaller one's."""
    smaller, together = found(couple, Choice(index=1)), np.zeros(read_image(couple).rgb.shape, np.uint8)
    quiet: list[str] = []
    told: list[str] = []
    alone = outlined(smaller, warnings=quiet)
    for one in (alone, outlined(found(couple, Choice()))):
        together[one.alpha > 0.5] = 255
    write_image(tmp_path / "mask.png", together)
    again = outlined(smaller, tmp_path / "mask.png", told)
    np.testing.assert_array_equal(again.alpha > 0.5, alone.alpha > 0.5)
    assert (quiet, told) == ([], ["mask_in_pieces"])


def test_a_label_map_that_is_given_back_is_the_label_map(
    figure: Figure, silhouette: Silhouette, labels: Labels, tmp_path: Path
) -> None:
    back = cv2.invertAffineTransform(silhouette.to_grid)
    size = (figure.rgb.shape[1], figure.rgb.shape[0])
    shown = cv2.warpAffine(LABEL_COLOURS[labels.labels.astype(int)], back, size, flags=cv2.INTER_NEAREST)
    write_image(tmp_path / "labels.png", np.asarray(shown, np.uint8))
    fitted = fit_template(figure, silhouette)
    again = label(figure, silhouette, fitted, tmp_path / "labels.png", (), LIMITS, quiet)
    assert (again.labels != labels.labels).mean() < 0.01
    at = figure.point("LeftKnee")
    stroke = LabelStroke(path=((float(at[0]), float(at[1])),), radius=6, part="right_leg")
    painted = label(figure, silhouette, fitted, None, (stroke,), LIMITS, quiet)
    x, y = np.rint(silhouette.to_grid[:, :2] @ at + silhouette.to_grid[:, 2]).astype(int)
    assert labels.labels[y, x] == BODY_PARTS.index("left_leg")
    assert painted.labels[y, x] == BODY_PARTS.index("right_leg")


def test_of_all_the_largest_stays_if_too_little_of_them_is_seen(couple: Path, tmp_path: Path) -> None:
    picture = read_image(couple).rgb.copy()
    width = sample_picture().shape[1]
    lowered = picture.shape[0] // 3
    picture[lowered:, :width] = picture[:-lowered, :width].copy()
    picture[:lowered, :width] = picture[2, 2]
    write_image(tmp_path / "cut.png", picture)
    with Run() as run:
        figures = find_figures(tmp_path / "cut.png", CharacterOptions(person_index="all"), run)
    assert [figure.index for figure in figures] == [1]
    assert [notice.code for notice in run.notices] == ["person_left_out"]


def test_of_all_whoever_cannot_be_cut_out_stays(couple: Path) -> None:
    """The second is nowhere to be seen in the picture's own alpha."""
    first, second = found(couple, Choice(index=0)), found(couple, Choice(index=1))
    hidden = replace(second, alpha=np.zeros(second.rgb.shape[:2], np.float32))
    everybody = CharacterOptions(person_index="all")
    with Run() as run:
        figures, silhouettes = cut_all_out([first, hidden], None, everybody, run)
    assert [figure.index for figure in figures] == [0] and len(silhouettes) == 1
    assert [notice.code for notice in run.notices] == ["person_left_out"]
    assert "Person 2" in run.notices[0].message
    for none in ([hidden], [hidden, hidden]):
        with pytest.raises(InputError) as refused, Run() as run:
            cut_all_out(none, None, everybody, run)
        assert refused.value.code == "no_person"


@pytest.mark.parametrize("kind", ["mask", "labels"])
def test_one_file_cannot_be_the_outline_of_all(couple: Path, tmp_path: Path, kind: str) -> None:
    write_image(tmp_path / "file.png", np.zeros((8, 8, 3), np.uint8))
    with pytest.raises(InputError) as refused, Run() as run:
        wake_up({"photo": couple, kind: tmp_path / "file.png"}, CharacterOptions(person_index="all"), tmp_path, run)
    assert refused.value.code == "one_outline_for_all"


def test_files_of_the_wrong_size_are_refused(tmp_path: Path) -> None:
    write_image(tmp_path / "small.png", np.zeros((20, 24, 3), np.uint8))
    for read, code in ((read_mask, "mask_size"), (read_labels, "labels_size")):
        with pytest.raises(InputError) as raised:
            read(tmp_path / "small.png", [(100, 120)], LIMITS)
        assert raised.value.code == code


def test_what_is_printed_in_front_is_behind_only_where_backs_are_mirrored(
    figure: Figure, silhouette: Silhouette, labels: Labels
) -> None:
    corners = figure.points[
        [BODY_LANDMARKS.index(f"{side}{joint}") for side in ("Left", "Right") for joint in ("Shoulder", "Hip")]
    ]
    x, y = np.rint(corners.mean(0)).astype(int)
    rgb = figure.rgb.copy()
    rgb[y - 12 : y + 12, x - 12 : x + 12] = (255, 30, 30)
    printed = replace(figure, rgb=rgb)
    red = []
    for back in ("mirror", "inpaint"):
        nowhere = np.zeros_like(labels.parting)
        picture = PictureOnGrid(printed.rgb, silhouette.alpha, silhouette.to_grid)
        tiles = paint_tiles(picture, labels, LimbSurfaces(nowhere, nowhere), None, back)
        red.append(int(((tiles.back[..., 0] > 200) & (tiles.back[..., 1] < 80)).sum()))
        assert ((tiles.body[..., 0] > 200) & (tiles.body[..., 1] < 80)).sum() > 300
    assert red[0] > 300 and red[1] == 0


def landmarks(**places: tuple[float, float]) -> np.ndarray:
    """Somebody who stands upright, arms down, in pixels; some points elsewhere."""
    upright = {
        **{"Nose": (100, 40), "LeftShoulder": (130, 80), "RightShoulder": (70, 80), "LeftHip": (120, 180)},
        **{"RightHip": (80, 180), "LeftWrist": (140, 190), "RightWrist": (60, 190), "LeftKnee": (120, 260)},
        **{"RightKnee": (80, 260), "LeftAnkle": (120, 340), "RightAnkle": (80, 340)},
    }
    return np.array([{**upright, **places}.get(name, (100, 100)) for name in BODY_LANDMARKS], np.float32)


def in_space(points: np.ndarray) -> np.ndarray:
    return np.stack([points[:, 0] / 170, -points[:, 1] / 170, np.zeros(len(points))], 1).astype(np.float32)


def told(points: np.ndarray, world: np.ndarray | None = None, legs: bool = True) -> list[str]:
    warnings: list[str] = []
    check_posture(
        points, in_space(points) if world is None else world, legs, lambda code, message: warnings.append(code)
    )
    return warnings


def test_postures_are_told() -> None:
    assert told(landmarks()) == []
    turned = landmarks()
    turned[:, 0] = 200 - turned[:, 0]
    assert told(turned) == ["person_from_behind"]
    assert told(landmarks(LeftWrist=(105, 5), RightWrist=(95, 5))) == ["hands_overhead"]
    seated = in_space(landmarks())
    for side in ("Left", "Right"):
        hip, knee = (BODY_LANDMARKS.index(f"{side}{joint}") for joint in ("Hip", "Knee"))
        seated[knee] = seated[hip] + [0, -0.1, 0.4]
    assert told(landmarks(), seated) == ["person_seated"]
    assert told(landmarks(), seated, legs=False) == []
    for lying in (landmarks()[:, ::-1], landmarks() * [1, -1]):
        with pytest.raises(InputError) as raised:
            told(np.asarray(lying, np.float32))
        assert raised.value.code == "person_lying"


def test_who_is_seen_from_behind_is_told_so(media: Callable[[str], Path]) -> None:
    warnings: list[str] = []
    found(media("orbit/turntable_man/frames/0004.png"), Choice(), warnings)
    assert "person_from_behind" in warnings
