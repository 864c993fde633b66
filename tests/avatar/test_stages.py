"""Stages: what they make of options."""

import numpy as np
import pytest

from engine.avatar.capture.cameras import ClipCameras
from engine.avatar.capture.dense import DenseCloud
from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.avatar.options import KnownLens
from engine.avatar.stages import STEREO_SIDE_PIXELS, ClipScan, lens_of_frames, stereo_side
from engine.geometry.camera import Camera
from engine.geometry.point_clouds.point_cloud import PointCloud


def test_a_lens_sees_in_shrunk_frames_what_it_sees_in_the_clip() -> None:
    known = KnownLens(focal=1580.0, centre=(530.0, 970.0), k1=0.05, k2=-0.01)
    lens = lens_of_frames(known, (1920, 1080), (1280, 720))
    point = np.array([[0.4, -0.7, -2.0]])
    clip = Camera((0.0, 0.0, 0.0), 1580.0, (530.0, 970.0), (1920, 1080), distortion=(0.05, -0.01, 0.0, 0.0))
    focal, k1, k2 = lens.parameters
    frame = Camera((0.0, 0.0, 0.0), focal, tuple(lens.centre), (1280, 720), distortion=(k1, k2, 0.0, 0.0))
    at_clip, at_frame = (camera.project(point, np.float64)[0, :2] for camera in (clip, frame))
    np.testing.assert_allclose((at_clip + 0.5) * 2 / 3 - 0.5, at_frame, atol=1e-9)
    assert lens.known


def test_without_a_principal_point_it_is_the_middle() -> None:
    lens = lens_of_frames(KnownLens(focal=900.0), (640, 360), (640, 360))
    assert lens.centre.tolist() == pytest.approx([179.5, 319.5])


def test_a_scan_without_what_stands_off_the_body_has_the_other_points_with_their_support() -> None:
    points = np.array([[0, 0, 0], [0, 0.1, 0], [0, 0.105, 0], [0, 0.2, 0]], np.float32)
    cloud = PointCloud(points, np.tile(np.array([0, 0, 1], np.float32), (4, 1)), np.zeros((4, 3), np.uint8))
    dense = DenseCloud(cloud, np.array([3, 4, 5, 6], np.uint8), ())
    scan = ClipScan(np.zeros(0, np.int64), (), (), dense, SpatialLandmarks({}))
    left = scan.without(np.array([[0, 0.1, 0.001]])).dense
    assert left.support.tolist() == [3, 6]
    np.testing.assert_array_equal(left.cloud.points, points[[0, 3]])


def test_stereo_takes_no_finer_pictures_than_show_a_millimetre_of_the_person() -> None:
    near, far = (Camera((0.0, 1.6, away), 1200.0, (359.5, 639.5), (1280, 720)) for away in (0.6, 2.0))
    none = np.zeros((0, 3))
    close_up = ClipCameras((near, None, near, far), (near, None, near, far), np.zeros(4, np.bool_), (), none)
    assert stereo_side(close_up) == 640  # a pixel of a frame is half a millimetre wide
    whole = ClipCameras((far, far), (far, far), np.zeros(2, np.bool_), (), none)
    assert stereo_side(whole) == STEREO_SIDE_PIXELS
