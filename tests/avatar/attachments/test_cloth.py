"""What hangs beside the body is as thick as cloth, and falls into parts where nothing is between them."""

from __future__ import annotations

import numpy as np
import trimesh

from engine.avatar.attachments.piece_mesh import piece_meshes
from engine.avatar.attachments.solid import CLOTH_INSIDE_METRES, CLOTH_OUTSIDE_METRES, CLOTH_REACH_METRES, cloth_depths
from engine.geometry.mesh.surface import triangle_areas
from engine.geometry.point_clouds.point_cloud import PointCloud


def wall(count: int) -> PointCloud:
    """A wall in the plane z = 0, half a metre wide, seen from +z."""
    across = np.stack(np.meshgrid(*[np.linspace(-0.25, 0.25, count)] * 2), -1).reshape(-1, 2)
    points = np.column_stack([across, np.zeros(len(across))]).astype(np.float32)
    normals = np.tile(np.array([0, 0, 1], np.float32), (len(points), 1))
    return PointCloud(points, normals, np.zeros((len(points), 3), np.uint8))


def test_cloth_goes_as_far_behind_its_outside_and_before_it_as_is_said() -> None:
    places = np.array([[0, 0, -0.004], [0, 0, -0.1], [0, 0, 0.02], [0.25 + 2 * CLOTH_REACH_METRES, 0, 0]])
    found = cloth_depths(places, wall(101))
    inside, outside = CLOTH_INSIDE_METRES - 0.004, CLOTH_OUTSIDE_METRES - 0.02
    np.testing.assert_allclose(found, [inside, CLOTH_INSIDE_METRES - 0.1, outside, -CLOTH_REACH_METRES], atol=1e-6)


def test_two_flaps_are_two_pieces_and_a_crumb_is_none() -> None:
    boxes = [trimesh.creation.box((width, width, 0.03)) for width in (0.1, 0.2, 0.01)]
    boxes = [box.subdivide().subdivide().subdivide() for box in boxes]
    for k, box in enumerate(boxes):
        box.apply_translation([0.5 * k, 0, 0])
    whole = trimesh.util.concatenate(boxes)
    small, large = piece_meshes(np.asarray(whole.vertices), np.asarray(whole.faces))[::-1]
    assert triangle_areas(*large).sum() > triangle_areas(*small).sum() > 0.015
    assert large[0][:, 0].min() > 0.35
    assert small[0][:, 0].max() < 0.06
