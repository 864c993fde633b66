"""Heads in profile: the half of a face that nobody sees is the other one's, and the face's network is not asked."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.known_truth.dressed_template import DRESSED_LOOKS, dress
from benchmarks.known_truth.known_person import PERSON_PICTURE_SIZE, draw_into
from benchmarks.known_truth.known_places import places
from engine.body.parts import BODY_PARTS
from engine.character.figure.face_region import in_profile
from engine.character.figure.figure import Choice, Figure, find_figure
from engine.character.fit.head import turn_head
from engine.character.parts.label_map import Labels
from engine.character.texture.limb_texture import LimbSurfaces
from engine.character.texture.texture import PictureOnGrid, paint_tiles
from engine.media.image import write_image
from engine.media.limits import Limits
from tests.character.parts.test_overlapping_legs import fitted_as

WALKING = DRESSED_LOOKS[3]


def figure(turn: float, folder: Path) -> Figure:
    """Somebody who walks, turned to their left by degrees."""
    known = draw_into(dress(WALKING).turned(turn), places(PERSON_PICTURE_SIZE)["street"])
    write_image(folder / "photo.png", known.rgb)
    return find_figure(folder / "photo.png", Choice(), False, Limits(), lambda code, message: None)


@pytest.mark.parametrize(("turn", "profile"), [(50, False), (-90, True)])
def test_a_head_is_in_profile_where_one_ear_hides_the_other(turn: float, profile: bool, tmp_path: Path) -> None:
    assert in_profile(figure(turn, tmp_path)) == profile


def test_what_the_network_makes_of_half_a_face_does_not_turn_the_head(tmp_path: Path) -> None:
    seen = figure(90, tmp_path)
    fitted = fitted_as({})
    assert seen.face is not None, "it finds a face all the same"
    assert turn_head(fitted, seen) is fitted


def test_in_profile_both_sides_of_a_head_are_alike() -> None:
    rgb = np.full((120, 80, 3), (60, 45, 35), np.uint8)
    rgb[30:70, 40:60] = (225, 175, 150)  # a face that looks to the right
    labels = np.full((120, 80), -1, np.int8)
    labels[15:75, 20:60], labels[75:115, 15:65] = BODY_PARTS.index("head"), BODY_PARTS.index("torso")
    none = np.zeros(labels.shape, np.bool_)
    found = Labels(labels, none, np.zeros(0, np.int8), none, np.full_like(labels, -1))
    face, alpha = np.array([50, 50, 12, 22, 0], np.float32), (labels >= 0).astype(np.float32)
    same = np.array([[1.0, 0, 0], [0, 1, 0]])
    tiles = paint_tiles(PictureOnGrid(rgb, alpha, same), found, LimbSurfaces(none, none), face, "mirror", turned=None)
    inner = np.s_[35:65, 44:55]
    np.testing.assert_array_equal(tiles.back[inner], rgb[inner])
    hair = paint_tiles(PictureOnGrid(rgb, alpha, same), found, LimbSurfaces(none, none), face, "mirror", turned=0.0)
    assert np.abs(hair.back[inner].astype(int) - rgb[inner]).mean() > 60
