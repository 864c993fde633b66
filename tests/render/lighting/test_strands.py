"""Hairs cover as much of a picture as they are long and wide."""

import numpy as np
import pytest

from engine.render.lighting.light import Lamps
from engine.render.lighting.strands import draw_strands, shade_strands


def drawn(points: np.ndarray, width: float, depth: float = 10.0) -> np.ndarray:
    picture = np.zeros((60, 60, 3), np.float32)
    strand = np.asarray(points, np.float32)[None]
    draw_strands(
        picture, np.full((60, 60), depth, np.float32), strand, np.ones_like(strand), np.full(strand.shape[:2], width)
    )
    return picture[..., 0]


@pytest.mark.parametrize("width", [0.2, 0.7, 1.0, 2.5])
@pytest.mark.parametrize("row", [30.0, 30.3, 30.5])
def test_a_level_hair_covers_its_area(width: float, row: float) -> None:
    found = drawn([[10, row, 1], [50, row, 1]], width)
    assert found.sum() == pytest.approx(40 * width, rel=0.04)
    assert found[:25].sum() == 0


def test_a_bent_hair_is_no_darker_at_its_joints() -> None:
    along = np.linspace(10, 50, 9)
    whole = drawn([[10, 30, 1], [50, 30, 1]], 0.8)
    pieces = drawn(np.stack([along, np.full(9, 30), np.ones(9)], 1), 0.8)
    np.testing.assert_allclose(pieces[30, 14:46], whole[30, 14:46], atol=0.2)
    assert pieces.sum() == pytest.approx(whole.sum(), rel=0.03)


def test_hair_behind_something_is_hidden() -> None:
    assert drawn([[10, 30, 1], [50, 30, 1]], 1.0, depth=0.5).sum() == 0


def test_nearer_hairs_lie_over_further_ones() -> None:
    picture = np.zeros((20, 20, 3), np.float32)
    strands = np.array([[[2, 10, 1.0], [18, 10, 1.0]], [[10, 2, 2.0], [10, 18, 2.0]]], np.float32)
    colours = np.stack([np.full((2, 3), 1.0), np.full((2, 3), 0.5)]).astype(np.float32)
    draw_strands(picture, np.full((20, 20), 9, np.float32), strands, colours, np.full((2, 2), 3.0))
    assert picture[10, 10, 0] == pytest.approx(1.0)
    assert picture[4, 10, 0] == pytest.approx(0.5)


def test_a_hair_pointing_at_the_lamp_gets_no_diffuse_light() -> None:
    lamps = Lamps(np.array([[0, 1, 0]], np.float32), np.ones((1, 3), np.float32))
    tangents = np.array([[0, 1, 0], [1, 0, 0]], np.float32)
    view = np.tile(np.array([0, 0, 1], np.float32), (2, 1))
    found = shade_strands(tangents, view, np.ones((2, 1)), lamps, np.ones((2, 3)), gloss=0.0)
    np.testing.assert_allclose(found[0], 0, atol=1e-6)
    assert found[1, 0] > 0.2


def test_shaded_hairs_are_darker_in_proportion() -> None:
    lamps = Lamps(np.array([[0, 0.6, 0.8]], np.float32), np.ones((1, 3), np.float32))
    tangents, view = np.tile([[1, 0, 0]], (2, 1)), np.tile([[0, 0, 1]], (2, 1))
    found = shade_strands(tangents, view, np.array([[1.0], [0.25]]), lamps, np.full((2, 3), 0.3), gloss=1.0)
    np.testing.assert_allclose(found[1], found[0] / 4, rtol=1e-5)
