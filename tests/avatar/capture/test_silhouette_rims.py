"""Along a sphere's outline the points and normals are the sphere's."""

import numpy as np
from textured_sphere import CENTRE, RADIUS, ring, seen_depth

from engine.avatar.capture.captured_view import CapturedView
from engine.avatar.capture.silhouette_rims import rim_points
from engine.geometry.multiview.visual_hull import visual_hull


def test_points_of_the_outline_lie_on_the_sphere_and_their_normals_point_away() -> None:
    cameras = [*ring(16), *ring(12, height=1.5), *ring(12, height=-1.5)]
    silhouettes = [seen_depth(camera) > 0 for camera in cameras]
    hull = visual_hull(silhouettes, cameras, 0.01)
    image = np.full((120, 120, 3), 77, np.uint8)
    found = rim_points(CapturedView(image, silhouettes[2], cameras[2]), hull)
    away = found.points - CENTRE
    distance = np.linalg.norm(away, axis=1)
    assert len(found) > 50
    assert np.median(np.abs(distance - RADIUS)) < 0.006  # a pixel is 7 mm wide
    assert np.median((away * found.normals).sum(axis=1) / distance) > np.cos(np.radians(8))
    assert (found.colours == 77).all()


def test_where_the_picture_ends_is_no_outline() -> None:
    cameras = ring(16)
    silhouettes = [seen_depth(camera) > 0 for camera in cameras]
    hull = visual_hull(silhouettes, cameras, 0.02)
    view = CapturedView(np.zeros((120, 120, 3), np.uint8), silhouettes[0], cameras[0]).cropped(0, 0, (60, 120))
    rows = view.camera.project(rim_points(view, hull).points)[:, 1]
    assert rows.max() < 58.5
