"""Two frames of one colour each: steps where they meet are known, and levelled; strips change nothing."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.avatar.texture.levelling import level_seams
from engine.avatar.texture.painting import PaintedTexture, paint
from engine.avatar.texture.views import FrameView
from engine.geometry.camera import Camera
from engine.render.rasterisation.rasteriser import Raster
from engine.render.textures.texture_bake import texel_raster
from tests.avatar.texture.conftest import Ball, ring

SIZE = 256


def plain(camera: Camera, level: float) -> FrameView:
    return FrameView(camera, lambda: np.full((*camera.size, 3), level, np.uint8))


@pytest.fixture(scope="module")
def raster(ball: Ball) -> Raster:
    return texel_raster(ball.surface.atlas, SIZE)


def halves(ball: Ball) -> NDArray[np.intp]:
    """Left faces by the first frame, right ones by the second, and a few at the top by none."""
    middles = ball.surface.vertices[ball.surface.triangles].mean(1)
    return np.where(middles[:, 1] > 0.9, -1, (middles[:, 0] > 0).astype(np.intp))


def painted_halves(ball: Ball, raster: Raster, strip: int = 1 << 18) -> PaintedTexture:
    front = ring(1)[0]
    return paint(ball.surface, raster, halves(ball), [plain(front, 100), plain(front, 120)], np.ones((2, 3)), strip)


def test_each_texel_has_the_colour_of_its_frame_and_seams_their_difference(ball: Ball, raster: Raster) -> None:
    found = painted_halves(ball, raster)
    labels = np.where(raster.triangle >= 0, halves(ball)[raster.triangle], -1)
    np.testing.assert_array_equal(found.known, labels >= 0)
    np.testing.assert_array_equal(found.colours[..., 0], np.select([labels == 0, labels == 1], [100, 120], 0))
    first, second = labels.ravel()[found.seams.T]
    assert len(found.seams) > 100
    np.testing.assert_allclose(found.jumps, np.repeat(20.0 * (second - first)[:, None], 3, 1))


def test_levelling_takes_the_step_out_and_leaves_the_rims(ball: Ball, raster: Raster) -> None:
    found = painted_halves(ball, raster)
    before = found.colours.copy()
    charts = np.where(raster.triangle >= 0, ball.surface.atlas.charts[raster.triangle], -1).astype(np.int32)
    level_seams(found, charts)
    values = found.colours.reshape(-1, 3).astype(float)
    inner = [charts.ravel()[found.seams + step] for step in (-1, 1, -SIZE, SIZE)]
    inside = np.all([each == charts.ravel()[found.seams] for each in inner], (0, 2))
    steps = np.abs(values[found.seams[inside, 0]] - values[found.seams[inside, 1]])
    assert steps.mean() < 2.5
    beside = np.zeros((SIZE, SIZE), np.bool_)
    beside[:, 1:] |= charts[:, 1:] != charts[:, :-1]
    beside &= found.known
    np.testing.assert_array_equal(found.colours[beside], before[beside])
    assert found.colours[found.known].min() >= 99 and found.colours[found.known].max() <= 121


def test_strips_give_the_same(ball: Ball, raster: Raster) -> None:
    whole, strips = painted_halves(ball, raster), painted_halves(ball, raster, strip=777)
    np.testing.assert_array_equal(whole.colours, strips.colours)
    np.testing.assert_array_equal(whole.jumps, strips.jumps)


def test_a_gain_multiplies_the_colours_of_its_frame(ball: Ball, raster: Raster) -> None:
    front = ring(1)[0]
    labels = np.zeros(len(ball.surface.triangles), np.intp)
    found = paint(ball.surface, raster, labels, [plain(front, 100)], np.array([[1.2, 1.0, 3.0]]))
    assert (found.colours[found.known] == [120, 100, 255]).all()
