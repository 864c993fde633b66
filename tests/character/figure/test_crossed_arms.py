"""Crossed arms: which is before the other, where the other goes on behind it, and what it is made of there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from engine.body.parts import BODY_PARTS
from engine.character.figure.crossed_arms import crossed_arms
from engine.character.figure.figure import Choice, Figure, find_figure
from engine.character.figure.silhouette import Silhouette, cut_out
from engine.character.fit.template_fit import FittedBody, load_human, pose_template
from engine.character.parts.crossed_labels import Behind
from engine.character.parts.label_map import Labels
from engine.character.parts.regions import limb_in_one_piece
from engine.character.stages import build_mesh, fit_template, label
from engine.character.texture.limb_texture import LimbSurfaces
from engine.character.texture.texture import PictureOnGrid, paint_tiles
from engine.media.limits import Limits
from tests.character.parts.test_regions import SHAPE, bar, rectangle

LEFT, RIGHT = BODY_PARTS.index("left_arm"), BODY_PARTS.index("right_arm")
Media = Callable[[str], Path]


def quiet(code: str, message: str) -> None:
    pass


def seen(photo: Path) -> tuple[Figure, Silhouette]:
    figure = find_figure(photo, Choice(), True, Limits(), quiet)
    return figure, cut_out(figure, None, (), Limits(), None, None, quiet)


@pytest.fixture(scope="module")
def man(media: Media) -> tuple[Figure, Silhouette, FittedBody]:
    """A man in a dark suit; his left forearm is before the right one, its hand on the right sleeve."""
    figure, silhouette = seen(media("fullbody/biden_arms_crossed_3q.jpg"))
    return figure, silhouette, fit_template(figure, silhouette)


def test_the_arm_whose_hand_is_seen_is_before_the_other(man: tuple[Figure, Silhouette, FittedBody]) -> None:
    figure, silhouette, fitted = man
    crossed = crossed_arms(figure, silhouette.alpha > 0.5)
    assert crossed is not None and crossed.behind == "Right"
    human = load_human()
    template = pose_template(fitted, silhouette.camera(fitted.picture_camera()), human)
    depth = {
        side: template.joints[[human.rig.index(f"{side}{joint}") for joint in ("ForeArm", "Hand")], 2].mean()
        for side in ("Left", "Right")
    }
    metres = (depth["Left"] - depth["Right"]) / template.pixels_per_metre
    assert metres > 0.06, "about as thick as an arm"


def test_a_hand_that_shows_a_little_says_as_much(media: Media) -> None:
    """A woman in a coat: cuff and wrist of her right hand are seen on her left sleeve, of the left one a finger's edge."""
    figure, silhouette = seen(media("fullbody/woman_coat_beret.jpg"))
    fitted = fit_template(figure, silhouette)
    assert fitted.crossed is not None and fitted.crossed.behind == "Left"
    labels = label(figure, silhouette, fitted, None, (), Limits(), quiet).labels
    cuffs = {RIGHT: (357, 366), LEFT: (350, 408)}  # the lower one hangs below its forearm
    for arm, cuff in cuffs.items():
        x, y = np.rint(silhouette.to_grid[:, :2] @ cuff + silhouette.to_grid[:, 2]).astype(int)
        assert (labels[y - 2 : y + 3, x - 2 : x + 3] == arm).all()


@pytest.mark.parametrize("name", ["man_mug_arm_across.png", "man_skirt_hands_front.jpg", "iper_apose_0.jpg"])
def test_an_arm_before_the_trunk_or_hands_that_meet_are_not_crossed_arms(media: Media, name: str) -> None:
    figure = find_figure(media(f"fullbody/{name}"), Choice(), True, Limits(), quiet)
    assert crossed_arms(figure, np.ones(figure.rgb.shape[:2], np.bool_)) is None


def test_the_arm_behind_is_whole_and_not_to_be_seen_where_the_other_is(
    man: tuple[Figure, Silhouette, FittedBody],
) -> None:
    figure, silhouette, fitted = man
    labels = label(figure, silhouette, fitted, None, (), Limits(), quiet)
    assert labels.behind is not None and labels.behind.limb == RIGHT
    mesh = build_mesh(figure, silhouette, fitted, labels)
    shape = labels.labels.shape
    hidden = labels.behind.area & (labels.labels == LEFT)
    assert hidden.sum() > 500
    right = mesh.pixels(np.flatnonzero(mesh.limb == RIGHT), shape)
    assert right[hidden].mean() > 0.95
    nearest = mesh.seen_layer((shape[0], shape[1]))
    of_right = mesh.layer[mesh.limb == RIGHT][0]
    assert (nearest[hidden] == of_right).mean() < 0.02


def test_an_arm_goes_on_where_it_is_behind_the_other() -> None:
    labels = np.full(SHAPE, -1)
    labels[rectangle((20, 30), (10, 110))] = LEFT
    labels[rectangle((0, 60), (50, 60))] = RIGHT
    labels[rectangle((20, 30), (60, 110))] = RIGHT  # the other's hand covers all that is beyond
    none = np.zeros(SHAPE, np.bool_)
    behind = Behind(LEFT, rectangle((22, 28), (40, 100)), none)
    found = Labels(
        labels.astype(np.int8), none, np.array([LEFT, RIGHT], np.int8), none, np.full(SHAPE, -1, np.int8), behind
    )
    template = bar((20, 30), (10, 20))
    whole, _ = limb_in_one_piece(
        found, LEFT, (LEFT, RIGHT), template, np.ones(2, np.bool_), rectangle((20, 30), (8, 14))
    )
    assert whole[25, 10:100].all()


def test_behind_the_other_an_arm_has_its_own_colours_and_its_hand_the_face_s() -> None:
    labels = np.full((200, 160), BODY_PARTS.index("torso"))
    labels[:60] = BODY_PARTS.index("head")
    labels[100:130, 10:150], labels[90:140, 70:120] = LEFT, RIGHT
    rgb = np.zeros((200, 160, 3), np.uint8)
    rgb[:60], rgb[60:] = (200, 150, 120), (90, 90, 90)
    rgb[labels == LEFT], rgb[labels == RIGHT] = (20, 20, 120), (220, 220, 40)
    rgb[108:114, 58:66] = (200, 150, 120)  # a finger on it, which does not go on
    area, hand, none = np.zeros((3, 200, 160), np.bool_)
    area[100:130, 70:120] = True
    hand[100:130, 100:120] = True
    apart = np.array([LEFT, RIGHT], np.int8)
    arms = np.isin(labels, apart)
    found = Labels(
        labels.astype(np.int8), none, apart, none, np.full(labels.shape, -1, np.int8), Behind(LEFT, area, hand)
    )
    face = np.float32((80, 30, 22, 26, 0))
    same = np.array([[1.0, 0, 0], [0, 1, 0]])
    picture = PictureOnGrid(rgb, np.ones((200, 160), np.float32), same)
    tiles = paint_tiles(picture, found, LimbSurfaces(arms, arms), face, "mirror")
    assert tiles.behind is not None and tiles.behind[0] == LEFT
    own = tiles.behind[1].astype(int)
    assert np.abs(own[104:126, 74:96] - (20, 20, 120)).max() <= 8, "its sleeve goes on"
    assert np.abs(own[104:126, 104:118] - (200, 150, 120)).max() <= 8
    np.testing.assert_array_equal(tiles.limbs[104:126, 74:116], rgb[104:126, 74:116])


@pytest.mark.parametrize("change", ["unseen", "from behind"])
def test_arms_that_are_not_seen_or_seen_from_behind_are_not_crossed(
    man: tuple[Figure, Silhouette, FittedBody], change: str
) -> None:
    figure, silhouette, _ = man
    if change == "unseen":
        figure = replace(figure, confidence=np.full_like(figure.confidence, 0.05))
    else:
        figure = replace(figure, points=figure.points * np.float32([-1, 1]) + [figure.rgb.shape[1], 0])
    assert crossed_arms(figure, silhouette.alpha > 0.5) is None
