"""What no view saw, filled over the surface: constants, lines, bounds and pieces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from engine.geometry.texture_charts.texture_atlas import TextureAtlas, atlas_from_uv, unwrap
from engine.render.rasterisation.attributes import interpolate
from engine.render.textures.texture_bake import BakedTexture, bake, texel_raster
from engine.render.textures.texture_fill import filled_over_surface

SIZE = 128


def known_where(
    vertices: NDArray, faces: NDArray, atlas: TextureAtlas, seen: NDArray[np.bool_], colours: NDArray
) -> tuple[BakedTexture, NDArray, NDArray]:
    """A texture with the colours of the vertices, known on the triangles that are seen; its places, and the whole of it."""
    raster = texel_raster(atlas, SIZE)
    on = raster.triangle >= 0
    whole = interpolate(colours, faces, raster)
    known = on & seen[raster.triangle]
    empty = bake(vertices, faces, atlas, [], SIZE)
    baked = replace(empty, colours=np.where(known[..., None], whole, 0), weights=known.astype(np.float32))
    return baked, on & ~known, whole


@pytest.fixture(scope="module")
def ball() -> tuple[NDArray, NDArray, TextureAtlas]:
    mesh = trimesh.creation.icosphere(3)
    vertices, faces = np.asarray(mesh.vertices), np.asarray(mesh.faces)
    return vertices, faces, unwrap(vertices, faces, SIZE, gap=4)[0]


def test_one_colour_is_continued_as_it_is_across_the_seams(ball) -> None:
    vertices, faces, atlas = ball
    assert atlas.charts.max() > 2
    seen = vertices[faces].mean(1)[:, 2] > 0.3
    baked, hole, whole = known_where(vertices, faces, atlas, seen, np.tile([20.0, 130, 240], (len(vertices), 1)))
    found = filled_over_surface(baked, vertices, faces, atlas)
    np.testing.assert_allclose(found[hole], whole[hole], atol=1e-3)
    np.testing.assert_array_equal(found[~hole], baked.colours[~hole])


def test_what_is_filled_lies_between_what_is_known_and_runs_smoothly(ball) -> None:
    vertices, faces, atlas = ball
    height = vertices[faces].mean(1)[:, 1]
    ramp = np.repeat(100 + 50 * vertices[:, 1:2], 3, 1)
    baked, hole, whole = known_where(vertices, faces, atlas, np.abs(height) > 0.5, ramp)
    found = filled_over_surface(baked, vertices, faces, atlas)
    assert found[hole].min() >= 100 - 51 and found[hole].max() <= 100 + 51
    assert np.abs(found[hole] - whole[hole]).mean() < 5
    assert np.corrcoef(found[hole][:, 0], whole[hole][:, 0])[0, 1] > 0.98


def test_on_a_plane_a_ramp_is_continued_as_a_ramp() -> None:
    count = 24
    y, x = np.mgrid[:count, :count] / (count - 1)
    flat = np.stack([x - 0.5 * y, np.sqrt(0.75) * y, 0 * x], 2).reshape(-1, 3)  # equilateral triangles
    a = (np.arange(count - 1)[:, None] * count + np.arange(count - 1)).ravel()
    faces = np.concatenate([np.stack([a, a + 1, a + count + 1], 1), np.stack([a, a + count + 1, a + count], 1)])
    atlas = atlas_from_uv(np.stack([x, y], 2).reshape(-1, 2), faces)
    middle = flat[faces].mean(1)
    hole = (np.abs(middle[:, :2] - middle[:, :2].mean(0)) < 0.2).all(1)
    baked, unseen, whole = known_where(
        flat, faces, atlas, ~hole, np.stack([200 * x, 90 * y + 10, 100 + 0 * x], 2).reshape(-1, 3)
    )
    found = filled_over_surface(baked, flat, faces, atlas)
    assert unseen.any() and np.abs(found[unseen] - whole[unseen]).max() < 4  # a fiftieth of the ramp


def test_a_piece_of_which_nothing_is_known_has_the_mean_of_the_rest() -> None:
    box = trimesh.creation.box()
    vertices = np.concatenate([box.vertices, box.vertices + 3])
    faces = np.concatenate([box.faces, box.faces + len(box.vertices)])
    atlas, _ = unwrap(vertices, faces, SIZE, gap=4)
    seen = np.arange(len(faces)) < len(box.faces)
    baked, hole, _ = known_where(vertices, faces, atlas, seen, np.tile([10.0, 20, 30], (len(vertices), 1)))
    found = filled_over_surface(baked, vertices, faces, atlas)
    np.testing.assert_allclose(found[hole], np.broadcast_to([10, 20, 30], found[hole].shape), atol=1e-3)


def test_where_nothing_or_all_is_known_nothing_changes(ball) -> None:
    vertices, faces, atlas = ball
    empty = bake(vertices, faces, atlas, [], SIZE)
    np.testing.assert_array_equal(filled_over_surface(empty, vertices, faces, atlas), empty.colours)
    full, _, _ = known_where(vertices, faces, atlas, np.ones(len(faces), np.bool_), 100 + 50 * vertices)
    np.testing.assert_array_equal(filled_over_surface(full, vertices, faces, atlas), full.colours)
