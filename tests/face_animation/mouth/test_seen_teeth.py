"""How much of its teeth a driver shows, on mouths that are painted."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from made_face import driver, placed
from numpy.typing import NDArray

from engine.face_animation.mouth.lip_contours import LOWER_INNER_LIP, UPPER_INNER_LIP
from engine.face_animation.mouth.modelled.modelled_mouth import ALL_TEETH, hidden_crown, shown_teeth
from engine.face_animation.mouth.seen_teeth import seen_teeth, teeth_shares
from engine.perception.face.landmarks import INNER_LOWER_LIP_VERTEX, INNER_UPPER_LIP_VERTEX
from engine.perception.face_track.face_crop import crop_face

SKIN, TEETH, DARK, TONGUE = (210, 160, 140), (220, 205, 190), (50, 20, 20), (235, 140, 140)
TOP, BOTTOM = 100, 140


def mouth(*bands: tuple[int, tuple[int, int, int]]) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """A picture of skin with a mouth 40 pixels high, painted in bands: how far down each goes, and its colour."""
    rgb = np.full((200, 200, 3), SKIN, np.uint8)
    start = TOP
    for end, colour in bands:
        cv2.rectangle(rgb, (60, start), (140, TOP + end), colour, -1)
        start = TOP + end
    face = np.full((478, 2), 30, np.float32)
    for lip, y in ((UPPER_INNER_LIP, TOP), (LOWER_INNER_LIP, BOTTOM)):
        face[list(lip)] = np.column_stack([np.linspace(60, 140, len(lip)), np.full(len(lip), y)])
    return rgb, face


@pytest.mark.parametrize("height", [0, 10, 20])
def test_upper_teeth_fill_what_they_fill(height: int) -> None:
    upper, lower = teeth_shares(*mouth((height, TEETH), (40, DARK)))
    assert upper == pytest.approx(height / 40, abs=0.05) and lower == pytest.approx(0, abs=0.02)


def test_lower_teeth_are_told_from_a_tongue_that_is_as_light() -> None:
    assert teeth_shares(*mouth((28, DARK), (40, TEETH)))[1] == pytest.approx(0.3, abs=0.05)
    assert teeth_shares(*mouth((28, DARK), (40, TONGUE)))[1] == pytest.approx(0, abs=0.02)


def test_where_no_dark_is_seen_nothing_is_told() -> None:
    assert teeth_shares(*mouth((10, TEETH), (40, TONGUE))) == pytest.approx(ALL_TEETH, abs=0.05)


def test_crowns_are_hidden_beyond_what_is_shown() -> None:
    front = np.zeros((478, 2))
    front[INNER_UPPER_LIP_VERTEX, 1], front[INNER_LOWER_LIP_VERTEX, 1] = 0.5, 0.9
    assert hidden_crown(0.15, front, 0.25) == pytest.approx(0.05)
    assert hidden_crown(0.15, front, 0.5) == 0 == hidden_crown(0.6, front, 1.0)
    assert hidden_crown(-0.1, front, 0.0) == 0


def test_whose_teeth_are_not_known_shows_all() -> None:
    assert shown_teeth(None, 3) == ALL_TEETH
    assert shown_teeth(np.array([[1.0, 1.0], [0.25, 0.5]]), 1) == (0.25, 0.5)


@pytest.mark.parametrize(("gap", "told"), [(4, False), (40, True)])
def test_of_a_mouth_that_hardly_parts_nothing_is_told(tmp_path: Path, gap: int, told: bool) -> None:
    rest = placed(60, (150, 130))
    mesh = rest.copy()
    for lip, y in ((UPPER_INNER_LIP, 200), (LOWER_INNER_LIP, 200 + gap)):
        mesh[list(lip), :2] = np.column_stack([np.linspace(115, 185, len(lip)), np.full(len(lip), y)])
        mesh[list(lip)[:: len(lip) - 1], 1] = 200 + gap / 2
    rgb = np.full((300, 300, 3), SKIN, np.uint8)
    cv2.rectangle(rgb, (110, 200), (190, 200 + gap), DARK, -1)
    shares = seen_teeth(driver(tmp_path, [mesh, mesh], 2 * [crop_face(rgb, mesh).crop], size=(300, 300)))
    np.testing.assert_allclose(shares, 0 if told else 1, atol=0.05)
