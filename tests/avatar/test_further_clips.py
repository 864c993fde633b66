"""What further clips measured is laid onto what the body's clip did, and counts with it."""

from __future__ import annotations

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation
from template_avatar import fitted_template

from engine.avatar.capture.dense import DenseCloud
from engine.avatar.further_clips import onto_body, with_further
from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.avatar.mesh import surface_of
from engine.avatar.stages import ClipScan
from engine.body.template import load_template
from engine.geometry.camera import Camera
from engine.geometry.point_clouds.point_cloud import PointCloud
from engine.geometry.registration.rigid import Similarity


def scan_of(cloud: PointCloud) -> ClipScan:
    cameras = (Camera((0, 1.2, 2.5), 900.0, (359.5, 639.5), (1280, 720)).aimed((0, 1.2, 2.5), (0, 1, 0)),)
    landmarks = SpatialLandmarks({}, np.full((68, 3), np.nan))
    dense = DenseCloud(cloud, np.full(len(cloud), 3, np.uint8), cameras)
    return ClipScan(np.zeros(1, np.int64), cameras, (np.ones((4, 4), bool),), dense, landmarks)


def test_a_further_clip_of_an_arm_and_the_back_comes_to_lie_on_the_body() -> None:
    surface = surface_of(load_template())
    person = trimesh.Trimesh(fitted_template().rest[surface.vertex_of], surface.triangles, process=False)
    clouds = []
    for seed in (1, 2):
        points, faces = trimesh.sample.sample_surface(person, 60_000, seed=seed)
        normals = person.face_normals[faces].astype(np.float32)
        clouds.append(PointCloud(points.astype(np.float32), normals, np.full(points.shape, 128, np.uint8)))
    body, close = clouds
    part = close[(close.points[:, 1] > 0.9) & ((close.normals[:, 2] < 0) | (close.points[:, 0] > 0.2))]
    moved = Similarity(Rotation.from_rotvec([0.01, -0.02, 0.008]).as_matrix(), np.array([0.008, -0.006, 0.01]))
    found = onto_body(scan_of(part).moved(moved), scan_of(body))
    off = np.linalg.norm(found.dense.cloud.points - part.points, axis=1)
    assert np.linalg.norm(moved(part.points) - part.points, axis=1).mean() > 0.01 > 0.002 > off.max()
    eye = scan_of(part).cameras[0].eye
    assert np.linalg.norm(np.subtract(found.cameras[0].eye, eye)) < 0.005, "its cameras come along"
    together = with_further(scan_of(body), [found]).dense
    assert len(together.cloud) == len(together.support) == len(body) + len(part)
