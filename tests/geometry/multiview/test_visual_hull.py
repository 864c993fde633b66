"""A sphere's silhouettes carve a body that holds the sphere and little more."""

import numpy as np
import pytest
from textured_sphere import CENTRE, RADIUS, ring, seen_depth

from engine.geometry.multiview.visual_hull import VisualHull, depth_range, visual_hull

SPACING = 0.02


@pytest.fixture(scope="module")
def hull() -> VisualHull:
    cameras = [*ring(12), *ring(12, height=1.5, first=0.2), *ring(12, height=-1.5)]
    return visual_hull([seen_depth(camera) > 0 for camera in cameras], cameras, SPACING)


def test_the_hull_holds_the_sphere_and_ends_a_voxel_beyond_it(hull: VisualHull) -> None:
    places = hull.origin + SPACING * np.stack(np.indices(hull.occupied.shape), -1)
    distance = np.linalg.norm(places - CENTRE, axis=-1)
    assert hull.occupied[distance < RADIUS].all()
    assert (distance[hull.occupied] < RADIUS + 3 * SPACING).mean() > 0.98
    assert np.abs(hull.box() - [CENTRE - RADIUS, CENTRE + RADIUS]).max() < 3 * SPACING


def test_its_surface_is_the_spheres(hull: VisualHull) -> None:
    points, normals = hull.surface()
    out = points - CENTRE
    distance = np.linalg.norm(out, axis=-1)
    assert np.abs(distance - RADIUS).mean() < 1.5 * SPACING
    assert np.median((normals * out).sum(axis=1) / distance) > np.cos(np.radians(10))


def test_lines_of_sight_enter_the_hull_just_before_the_sphere_and_leave_it_behind(hull: VisualHull) -> None:
    camera = ring(1, first=0.4)[0]
    depth = seen_depth(camera)
    reach = depth_range(hull, camera, depth > 0)
    assert (reach[depth == 0] == 0).all()
    seen = depth > 0
    before = depth[seen] - reach[seen][:, 0]
    assert before.min() > -SPACING / 2  # a step
    assert np.median(before) < 2 * SPACING
    assert (reach[seen][:, 1] > depth[seen]).all()
    middle = 60, 60
    assert reach[middle][1] - reach[middle][0] == pytest.approx(2 * RADIUS, abs=3 * SPACING)


def test_what_lies_beyond_a_pictures_border_is_left_to_other_views() -> None:
    cameras = ring(24)
    cut = [camera.cropped(0, 0, (60, 120)) if i % 2 else camera for i, camera in enumerate(cameras)]
    whole = visual_hull([seen_depth(camera) > 0 for camera in cameras], cameras, SPACING)
    half = visual_hull([seen_depth(camera) > 0 for camera in cut], cut, SPACING)
    assert half.box()[0][1] < 1 - 0.9 * RADIUS
    assert np.abs(half.box() - whole.box()).max() < 3 * SPACING


def test_one_wrong_silhouette_of_many_does_not_take_the_body_away() -> None:
    cameras = ring(16)
    silhouettes = [seen_depth(camera) > 0 for camera in cameras]
    silhouettes[3][:] = False
    assert visual_hull(silhouettes, cameras, SPACING).box()[1][1] > 1 + 0.9 * RADIUS


def test_empty_silhouettes_are_refused() -> None:
    cameras = ring(6)
    with pytest.raises(ValueError, match="nothing lies within the silhouettes"):
        visual_hull([np.zeros(camera.size, bool) for camera in cameras], cameras, SPACING)
