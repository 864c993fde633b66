"""People of known shape, and clouds of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.avatar.registration.models import HumanModels
from engine.geometry.mesh.surface import face_normals, triangle_areas
from engine.geometry.point_clouds.point_cloud import PointCloud
from engine.geometry.registration.rigid import Similarity

TO_HEAD = Similarity(1.3 * Rotation.from_rotvec([0.1, 0.4, -0.1]).as_matrix(), np.array([0.1, -1.5, 0.3]))
"""From the body's world to that of the head's clip."""


@dataclass(frozen=True)
class KnownPerson:
    """The parameters of a body in A-pose, all the template's vertices for them, and landmarks, metres."""

    parameters: NDArray[np.float64]
    vertices: NDArray[np.float64]
    landmarks: SpatialLandmarks


def sampled(models: HumanModels, vertices: NDArray[np.float64], count: int, noise: float, part: str = "") -> PointCloud:
    """A cloud of so many points of what is visible of the skin (S, 3), or of a region of it, with noise in metres."""
    random = np.random.default_rng(1)
    triangles = models.skin.triangles[models.skin.visible]
    if part:
        triangles = triangles[models.skin.regions[part][triangles].all(1)]
    areas = triangle_areas(vertices, triangles)
    which = random.choice(len(triangles), count, p=areas / areas.sum())
    shares = random.dirichlet(np.ones(3), count)
    normals = face_normals(vertices, triangles)[which]
    points = np.einsum("nk,nkc->nc", shares, vertices[triangles[which]]) + normals * random.normal(0, noise, (count, 1))
    grey = np.full((count, 3), 128, np.uint8)
    return PointCloud(points.astype(np.float32), normals.astype(np.float32), grey)
