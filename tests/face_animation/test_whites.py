"""The tint of what is white: as an eye shows it, but always between grey and the skin's hue."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import BROWN, SKIN, WHITE, painted, placed, shut
from numpy.typing import NDArray

from engine.face_animation.skin_colour import skin_colour
from engine.face_animation.whites import (
    TEETH_HUE_SHARE,
    WHITE_HUE_SHARE_RANGE,
    eye_whites,
    hue_share,
    teeth_tint,
    white_luminance,
    white_tint,
)
from engine.imaging.luminance import LUMINANCE_WEIGHTS

SIZE = (360, 320)


@pytest.fixture(scope="module")
def mesh() -> NDArray[np.float32]:
    return shut(placed(120, (180, 140)), 1.6)


def share_in(tint: NDArray, skin: NDArray) -> float:
    """How much of the skin's hue is in a tint, if it is of that hue at all."""
    hue = np.log(skin / float(skin @ LUMINANCE_WEIGHTS))
    share = float(np.log(tint) @ hue / (hue @ hue))
    expected = np.exp(share * hue)
    np.testing.assert_allclose(tint, expected / float(expected @ LUMINANCE_WEIGHTS), atol=3e-3)
    return share


def test_the_whites_of_eyes_are_found_beside_their_irises(mesh: NDArray) -> None:
    for side in range(2):
        found = eye_whites(painted(mesh, SIZE), mesh, side)
        assert len(found) > 20
        assert np.abs(found - WHITE).max() < 30 < np.linalg.norm(np.array(WHITE) - BROWN)


@pytest.mark.parametrize("cast", [(1.0, 1.0, 1.0), (0.6, 0.6, 1.0), (1.0, 0.75, 0.4), (0.6, 1.0, 0.6)])
def test_the_tint_is_between_grey_and_the_skin_whatever_the_eyes_show(mesh: NDArray, cast: tuple) -> None:
    rgb = painted(mesh, SIZE)
    white = np.abs(rgb.astype(int) - WHITE).max(axis=2) < 12
    rgb[white] = np.array(WHITE) * cast
    share = share_in(white_tint(rgb, mesh), np.array(SKIN, float))
    assert WHITE_HUE_SHARE_RANGE[0] - 0.05 <= share <= WHITE_HUE_SHARE_RANGE[1] + 0.05


def test_a_varnish_over_all_tints_whites_more_than_clean_light(mesh: NDArray) -> None:
    rgb = painted(mesh, SIZE)
    white = np.abs(rgb.astype(int) - WHITE).max(axis=2) < 12
    warm = rgb.copy()
    warm[white] = np.array(WHITE) * (1.0, 0.85, 0.65)
    assert white_tint(warm, mesh)[2] < white_tint(rgb, mesh)[2] - 0.03


@pytest.mark.parametrize("light", [(1.0, 1.0, 1.0), (1.0, 0.8, 0.55)])
def test_teeth_have_a_share_of_the_skin_s_hue_whatever_else_the_picture_shows(mesh: NDArray, light: tuple) -> None:
    """A warm light makes them as much warmer; lashes and shade over the whites of eyes do not, nor does a collar in another light."""
    rgb = (painted(mesh, SIZE) * np.array(light)).astype(np.uint8)
    white = np.abs(rgb.astype(int) - np.array(WHITE) * light).max(axis=2) < 12
    for seen in ((130, 60, 40), (200, 210, 255)):
        rgb[white] = seen
        rgb[-40:] = seen
        skin = skin_colour(rgb, mesh)
        expected = (skin / skin[0]) ** TEETH_HUE_SHARE
        np.testing.assert_allclose(teeth_tint(rgb, mesh), expected / float(expected @ LUMINANCE_WEIGHTS), atol=1e-6)


def test_the_skin_has_all_of_its_hue_and_grey_has_none(mesh: NDArray) -> None:
    rgb = painted(mesh, SIZE)
    for colour, share in ((SKIN, 1.0), ((200, 200, 200), 0.0)):
        assert hue_share(rgb, mesh, np.tile(np.array(colour, float), (20, 1))) == pytest.approx(share, abs=0.02)


def test_whites_are_as_light_as_the_eye_that_shows_them_better(mesh: NDArray) -> None:
    rgb = painted(mesh, SIZE)
    both = white_luminance(rgb, mesh)
    assert both == pytest.approx(float(np.array(WHITE) @ LUMINANCE_WEIGHTS), rel=0.06)
    half = rgb.copy()
    half[:, : SIZE[0] // 2] //= 3
    assert white_luminance(half, mesh) == pytest.approx(both, rel=0.06)
    assert white_luminance(rgb, mesh * np.float32((0.02, 0.02, 1))) == 0, "too small to be seen"
