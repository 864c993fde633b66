"""Atlases: a surface's own, and one that is cut and packed; gaps, distortion, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from engine.body import load_template
from engine.geometry.mesh.surface import triangulate
from engine.geometry.texture_charts.texture_atlas import TextureAtlas, atlas_from_uv, unwrap
from engine.render.textures.texture_bake import chart_gap, texel_raster

SIZE = 512


@pytest.fixture(scope="module")
def torus() -> tuple[NDArray, NDArray]:
    mesh = trimesh.creation.torus(1.0, 0.4, major_sections=48, minor_sections=24)
    return np.asarray(mesh.vertices), np.asarray(mesh.faces)


@pytest.fixture(scope="module")
def atlas(torus: tuple[NDArray, NDArray]) -> tuple[TextureAtlas, NDArray]:
    return unwrap(*torus, SIZE, gap=8)


def test_each_place_shows_its_triangles_own_vertices(torus, atlas) -> None:
    found, shown = atlas
    np.testing.assert_array_equal(shown[found.corners], torus[1])


def test_charts_lie_apart_and_show_all_of_the_surface(torus, atlas) -> None:
    found, _ = atlas
    raster = texel_raster(found, SIZE)
    on = raster.triangle >= 0
    assert len(np.unique(raster.triangle[on])) > 0.99 * len(torus[1])
    charts = np.where(on, found.charts[raster.triangle], -1)
    assert chart_gap(charts) >= 7.5
    assert on.mean() > 0.25


def test_triangles_do_not_lie_on_each_other(torus, atlas) -> None:
    """The texels that are covered are as many as the triangles' areas on the texture say."""
    found, _ = atlas
    a, b, c = (found.uv[found.corners[:, k]].astype(float) for k in range(3))
    one, other = b - a, c - a
    areas = np.abs(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]) / 2
    covered = (texel_raster(found, SIZE).triangle >= 0).mean()
    assert covered == pytest.approx(areas.sum(), rel=0.01)


def test_charts_are_little_distorted(torus, atlas) -> None:
    vertices, triangles = torus
    found, _ = atlas
    angles = []
    for points in (vertices[triangles], found.uv[found.corners].astype(float)):
        one, other = points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
        angles.append(np.arccos((one * other).sum(1) / np.linalg.norm(one, axis=1) / np.linalg.norm(other, axis=1)))
    assert np.degrees(np.abs(angles[0] - angles[1])).mean() < 6


def test_cutting_is_the_same_each_time(torus, atlas) -> None:
    again, shown = unwrap(*torus, SIZE, gap=8)
    np.testing.assert_array_equal(again.uv, atlas[0].uv)
    np.testing.assert_array_equal(shown, atlas[1])


def test_the_templates_own_charts() -> None:
    template = load_template()
    span = slice(*template.parts["body"])
    own = atlas_from_uv(template.uv, triangulate(template.uv_quads[span]))
    assert len(own.corners) == 2 * len(template.quads[span])
    assert 1 <= own.charts.max() + 1 < 60
    # two triangles of a quad are on one chart
    half = len(own.corners) // 2
    np.testing.assert_array_equal(own.charts[:half], own.charts[half:])
    raster = texel_raster(own, SIZE)
    assert 0.4 < (raster.triangle >= 0).mean() < 0.9


def test_pieces_triangles_without_area_and_vertices_of_none() -> None:
    box = trimesh.creation.box()
    count = len(box.vertices)
    vertices = np.concatenate([box.vertices, box.vertices + 3, [[9.0, 9, 9]]])
    faces = np.concatenate([box.faces, box.faces + count, [[0, 1, 0]]])
    found, shown = unwrap(vertices, faces, 256)
    assert len(found.corners) == len(faces)
    np.testing.assert_array_equal(shown[found.corners], faces)


def test_what_cannot_be_unfolded_is_refused(torus) -> None:
    vertices, triangles = torus
    with pytest.raises(ValueError, match="triangles"):
        unwrap(vertices, triangles[:0], SIZE)
    with pytest.raises(ValueError, match="finite"):
        unwrap(np.where(vertices > 1.2, np.nan, vertices), triangles, SIZE)
    with pytest.raises(ValueError, match="not there"):
        unwrap(vertices, triangles + len(vertices), SIZE)
    with pytest.raises(ValueError, match="within"):
        atlas_from_uv(np.array([[0, 0], [1.5, 0], [0, 1.0]]), np.array([[0, 1, 2]]))
    with pytest.raises(ValueError, match="no place"):
        atlas_from_uv(np.zeros((2, 2)), np.array([[0, 1, 2]]))
