"""Interpolation and texture sampling on fields whose values are known in closed form."""

import numpy as np

from engine.render.rasterisation.attributes import interpolate, sample_texture
from engine.render.rasterisation.rasteriser import rasterise


def test_a_linear_attribute_is_reproduced() -> None:
    rng = np.random.default_rng(0)
    vertices = np.concatenate([rng.integers(0, 60, (30, 2)), rng.uniform(1, 2, (30, 1))], 1).astype(np.float32)
    triangles = np.arange(30).reshape(-1, 3)
    raster = rasterise(vertices, triangles, (60, 60))
    found = interpolate(vertices[:, :2], triangles, raster, background=-1)
    ys, xs = np.mgrid[:60, :60]
    covered = raster.triangle >= 0
    np.testing.assert_allclose(found[covered], np.stack([xs, ys], 2)[covered], atol=1e-3)
    assert (found[~covered] == -1).all()


def test_attributes_may_have_their_own_indices() -> None:
    vertices = np.array([[0, 0, 1], [10, 0, 1], [0, 10, 1]], np.float32)
    raster = rasterise(vertices, np.array([[0, 1, 2]]), (8, 8))
    found = interpolate(np.array([[7.0], [3.0]]), np.array([[1, 0, 1]]), raster)
    np.testing.assert_allclose(found[0, 5], 5, atol=1e-6)


def test_texel_centres_give_the_texels_back() -> None:
    texture = np.random.default_rng(1).integers(0, 256, (5, 7, 3), np.uint8)
    ys, xs = np.mgrid[:5, :7]
    uv = np.stack([(xs + 0.5) / 7, (ys + 0.5) / 5], 2)
    np.testing.assert_allclose(sample_texture(texture, uv), texture, atol=1e-3)


def test_between_texels_the_texture_is_bilinear_and_continued_beyond_its_border() -> None:
    texture = np.array([[[0.0], [10.0]], [[20.0], [30.0]]], np.float32)
    uv = np.array([[[0.5, 0.5], [0.375, 0.25], [-3.0, -3.0], [9.0, 9.0]]])
    np.testing.assert_allclose(sample_texture(texture, uv)[0, :, 0], [15, 2.5, 0, 30], atol=1e-6)


def test_uncovered_pixels_are_not_looked_up() -> None:
    covered = np.array([[True, False]])
    found = sample_texture(np.ones((2, 2, 1), np.float32), np.full((1, 2, 2), 0.5), covered)
    assert found[0, 0, 0] == 1 and found[0, 1, 0] == 0
