"""What views see beyond doubt: a face's skin, where nothing is before it."""

from __future__ import annotations

import numpy as np

from engine.avatar.attachments.body_surface import BodySurface
from engine.avatar.attachments.seen_around import seen_around
from engine.geometry.camera import Camera
from engine.geometry.multiview.visual_hull import VisualHull
from engine.geometry.point_clouds.point_cloud import PointCloud

SIDE = 41


def test_through_what_is_before_a_face_nobody_looks() -> None:
    """A flat face, the right half of which is behind a brim, 3 cm before it; and a place between both, and its like at the left."""
    y, x = np.divmod(np.arange(SIDE * SIDE), SIDE)
    skin = np.stack([x - SIDE // 2, y - SIDE // 2, 0 * x], 1) * 0.0025
    corner = np.arange(SIDE * SIDE).reshape(SIDE, SIDE)[:-1, :-1].ravel()
    triangles = np.concatenate([corner[:, None] + [0, 1, SIDE], corner[:, None] + [1, SIDE + 1, SIDE]]).astype(np.int32)
    everywhere, nowhere = np.ones(len(skin), np.bool_), np.zeros(len(skin), np.bool_)
    body = BodySurface(skin, triangles, nowhere, everywhere, everywhere)
    brim = skin[skin[:, 0] > 0] + [0, 0, 0.03]
    points = np.concatenate([skin, brim]).astype(np.float32)
    normals = np.tile(np.array([0, 0, 1], np.float32), (len(points), 1))
    cloud = PointCloud(points, normals, np.zeros(points.shape, np.uint8))
    eye = (0.0, 0.0, 0.5)
    camera = Camera((0.0, 0.0, 0.0), 400.0, (79.5, 79.5), (160, 160)).aimed(eye, (0, 0, 0))
    hull = VisualHull(np.ones((2, 2, 2), np.bool_), np.zeros(3), 0.1)
    seen = seen_around(body, hull, cloud, [camera], near=1)
    places = np.array([[-0.03, 0, 0.015], [0.03, 0, 0.015]])
    votes = seen.votes(places, np.ones(2, np.bool_))
    assert votes[:, 0].tolist() == [1, 0], "views that look through"
