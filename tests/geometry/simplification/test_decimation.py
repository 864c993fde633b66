"""Decimation against shapes whose fewest triangles are known, and against the template's silhouette in motion."""

import numpy as np
import pytest
import trimesh
from template_character import template_character, walk

from engine.geometry.camera import Camera
from engine.geometry.mesh.welding import weld
from engine.geometry.rigging.skeleton import Skeleton
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import skin
from engine.geometry.simplification.decimation import decimate, joint_importance
from engine.motion.kinematics import pose_transforms
from engine.render.rasterisation.rasteriser import rasterise

TWO = Skeleton(("Hips", "Spine"), np.array([-1, 0], np.int32), np.array([[0, 0, 0], [0, 0.5, 0]], np.float32))


def plain(vertices: np.ndarray, triangles: np.ndarray, uv: np.ndarray | None = None, joint: int = 0) -> SkinnedMesh:
    count = len(vertices)
    bones = np.zeros((count, 4), np.uint8)
    bones[:, 0] = joint
    weights = np.tile(np.array([1, 0, 0, 0], np.float32), (count, 1))
    charted = np.asarray(vertices[:, :2] if uv is None else uv, np.float32)
    texture = np.zeros((4, 4, 3), np.uint8)
    return SkinnedMesh(TWO, vertices.astype(np.float32), triangles.astype(np.int32), charted, bones, weights, texture)


def grid(size: int) -> tuple[np.ndarray, np.ndarray]:
    """A flat square of (size - 1)^2 cells over [0, 1]^2."""
    y, x = np.mgrid[:size, :size] / (size - 1)
    index = np.arange(size * size).reshape(size, size)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return np.stack([x.ravel(), y.ravel(), np.zeros(size * size)], 1), triangles


def area(points: np.ndarray, triangles: np.ndarray) -> float:
    a, b, c = (points[triangles[:, k]].astype(float) for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def surface(mesh: SkinnedMesh) -> trimesh.Trimesh:
    """The mesh without its texture's seams."""
    point = weld(mesh)
    return trimesh.Trimesh(mesh.vertices[np.unique(point, return_index=True)[1]], point[mesh.triangles], process=False)


def test_a_fine_cube_stays_a_cube_down_to_a_few_triangles() -> None:
    box = trimesh.creation.box()
    for _ in range(4):
        box = box.subdivide()
    found = decimate(plain(box.vertices, box.faces, np.zeros((len(box.vertices), 2))), 24).mesh
    assert len(found.triangles) == 24
    assert surface(found).volume == pytest.approx(1, abs=1e-6) and surface(found).is_watertight
    assert (np.abs(found.vertices).max(1) == 0.5).all()


def test_a_flat_square_keeps_its_border_and_its_chart() -> None:
    vertices, triangles = grid(21)
    found = decimate(plain(vertices, triangles), 2).mesh
    assert len(found.triangles) == 2
    np.testing.assert_array_equal(np.unique(found.vertices, axis=0), [[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0]])
    np.testing.assert_array_equal(found.uv, found.vertices[:, :2])


def test_both_sides_of_a_seam_go_together() -> None:
    """A square cut in its middle: the right half lies elsewhere on the texture."""
    vertices, triangles = grid(21)
    right = (vertices[triangles].mean(1)[:, 0] > 0.5)[:, None] & (vertices[triangles][..., 0] >= 0)
    cut = np.flatnonzero(vertices[:, 0] == 0.5)
    twin = np.arange(len(vertices))
    twin[cut] = len(vertices) + np.arange(len(cut))
    corners = np.where(right, twin[triangles], triangles)
    places = np.concatenate([vertices, vertices[cut]])
    uv = places[:, :2].copy()
    uv[np.unique(corners[right[:, 0]])] += [0.25, 0.0]
    mesh = decimate(plain(places, corners, uv), 4).mesh
    assert len(mesh.triangles) == 4 and len(mesh.vertices) == 8
    assert area(mesh.vertices, mesh.triangles) == pytest.approx(1)
    chart = np.concatenate([mesh.uv, np.zeros((len(mesh.uv), 1), np.float32)], 1)
    assert area(chart, mesh.triangles) == pytest.approx(1)
    for triangle in mesh.triangles:  # no triangle reaches over the cut
        assert np.ptp(mesh.uv[triangle, 0] - mesh.vertices[triangle, 0]) == 0


def test_parts_that_only_touch_stay_apart() -> None:
    box = trimesh.creation.box().subdivide().subdivide().subdivide()
    lower, upper = (plain(box.vertices + np.array([0, k, 0]), box.faces, joint=k) for k in range(2))
    both = SkinnedMesh(
        TWO,
        *(
            np.concatenate([getattr(lower, name), getattr(upper, name) + shift])
            for name, shift in (("vertices", 0), ("triangles", len(lower.vertices)))
        ),
        *(np.concatenate([getattr(lower, name), getattr(upper, name)]) for name in ("uv", "bones", "weights")),
        texture=lower.texture,
    )
    both = SkinnedMesh(**{**vars(both), "uv": np.zeros_like(both.uv)})
    found = decimate(both, 64).mesh
    of_joint = found.bones[found.triangles, 0]
    assert (of_joint == of_joint[:, :1]).all() and len(found.triangles) == 64
    assert surface(found).volume == pytest.approx(2, abs=1e-6)


def test_what_matters_for_good_stays() -> None:
    vertices, triangles = grid(21)
    importance = np.ones(len(vertices))
    importance[[222, 137]] = np.inf
    found = decimate(plain(vertices, triangles), 6, importance)
    assert {222, 137} <= set(found.kept.tolist())
    assert len(found.mesh.triangles) == 6  # two points inside a square of two triangles: two more for each


def test_nothing_is_done_where_the_budget_is_kept() -> None:
    vertices, triangles = grid(5)
    mesh = plain(vertices, triangles)
    found = decimate(mesh, 32)
    assert found.mesh is mesh and (found.kept == np.arange(25)).all()


@pytest.fixture(scope="module")
def fine() -> SkinnedMesh:
    return template_character(subdivided=True, texture_size=64)


def silhouette(mesh: SkinnedMesh, posed: np.ndarray, azimuth: float) -> np.ndarray:
    camera = Camera((0, 0, 0), 600, (199.5, 299.5), (600, 400)).aimed(
        (4 * np.sin(azimuth), 1.0, 4 * np.cos(azimuth)), (0, 0.85, 0)
    )
    return rasterise(camera.project(posed), mesh.triangles, camera.size, perspective=True).triangle >= 0


def test_the_template_stays_closed_and_every_vertex_stays_itself(fine: SkinnedMesh) -> None:
    found, kept = decimate(fine, 20_000)
    assert 19_990 <= len(found.triangles) <= 20_000
    closed = surface(found)
    assert closed.is_watertight and closed.is_winding_consistent
    assert closed.volume == pytest.approx(surface(fine).volume, rel=2e-3)
    for name in ("vertices", "uv", "bones", "weights"):
        np.testing.assert_array_equal(getattr(found, name), getattr(fine, name)[kept])


@pytest.mark.parametrize("triangles", [60_000, 10_000])
def test_the_silhouette_is_kept_at_rest_and_in_motion(fine: SkinnedMesh, triangles: int) -> None:
    found = decimate(fine, triangles).mesh
    clip = walk(fine.skeleton, 8, travels=False)
    transforms = pose_transforms(fine.skeleton, clip.rotations, clip.root)
    least = 0.995 if triangles == 60_000 else 0.985
    for azimuth, frame in ((0.0, 2), (1.2, 5), (3.0, 0)):
        before, after = (
            silhouette(mesh, skin(mesh.vertices, mesh.bones, mesh.weights, transforms[frame]), azimuth)
            for mesh in (fine, found)
        )
        assert (before & after).sum() / (before | after).sum() > least


def test_an_important_head_keeps_more_of_its_triangles(fine: SkinnedMesh) -> None:
    counts = []
    for importance in (None, joint_importance(fine, {"Head": 30.0, "NoSuchJoint": 2.0})):
        mesh = decimate(fine, 8_000, importance).mesh
        counts.append(int((mesh.vertices[mesh.triangles][:, :, 1].mean(1) > 1.5).sum()))
    assert counts[1] > 1.5 * counts[0]
