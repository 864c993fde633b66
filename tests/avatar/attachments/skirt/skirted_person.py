"""A person of the template in cloth that hangs from the hips, filmed from all around."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from engine.avatar.attachments.attaching import Sighting, body_surface
from engine.avatar.attachments.body_surface import BodySurface
from engine.avatar.attachments.skirt.legs import Legs, legs_of
from engine.avatar.registration.models import HumanModels
from engine.geometry.camera import Camera
from engine.geometry.mesh.surface import vertex_normals
from engine.geometry.point_clouds.point_cloud import PointCloud, joined
from engine.render.rasterisation.rasteriser import rasterise

VIEWS = 24
WIDE_METRES, DEEP_METRES = 0.23, 0.19
"""Half axes of the ellipse as which it hangs."""
WAIST_METRES = 0.12
"""Metres above the crotch from which it hangs."""
POINT_EVERY_PIXELS = 11

Mesh = tuple[np.ndarray, np.ndarray]


def hanging(legs: Legs, turns: np.ndarray, drop: Callable[[np.ndarray], np.ndarray]) -> Mesh:
    """Cloth in the directions `turns`, from the left over the front, down to `drop` of them, metres below the crotch; it goes all around where
    these do."""
    rows = np.linspace(WAIST_METRES, -drop(turns), 30)
    x = np.broadcast_to(legs.axis[0] + WIDE_METRES * np.cos(turns), rows.shape)
    z = np.broadcast_to(legs.axis[1] + DEEP_METRES * np.sin(turns), rows.shape)
    places = np.stack([x, legs.crotch + rows, z], -1).reshape(-1, 3)
    count = len(turns)
    row, turn = (one.ravel() for one in np.meshgrid(np.arange(29), np.arange(count), indexing="ij"))
    following = (turn + 1) % count
    if np.ptp(turns) < 1.9 * np.pi:
        row, turn, following = (one[following > turn] for one in (row, turn, following))
    a, b = row * count + turn, row * count + following
    triangles = np.concatenate([np.stack([a, b, b + count], 1), np.stack([a, b + count, a + count], 1)])
    return places, triangles.astype(np.int32)


def filmed(body: BodySurface, worn: Mesh) -> Sighting:
    """Silhouettes of a person with what is worn, and points of what frames show."""
    lens = Camera((0.0, 0.0, 0.0), 500.0, (99.5, 219.5), (440, 200))
    places = np.concatenate([body.vertices, worn[0]])
    triangles = np.concatenate([body.triangles, worn[1] + np.int32(len(body.vertices))])
    normals = vertex_normals(places, triangles)
    masks, cameras, clouds = [], [], []
    for k in range(VIEWS):
        turn = 2 * np.pi * k / VIEWS
        camera = lens.aimed((2.6 * np.sin(turn), 0.1 + 0.2 * (k % 2), 2.6 * np.cos(turn)), (0, -0.1, 0))
        shown = rasterise(camera.project(places), triangles, camera.size, perspective=True)
        cameras.append(camera)
        masks.append(shown.triangle >= 0)
        corners = triangles[shown.triangle[masks[-1]][::POINT_EVERY_PIXELS]]
        shares = shown.barycentrics[masks[-1]][::POINT_EVERY_PIXELS]
        points, facing = (np.einsum("nk,nkd->nd", shares, of[corners]).astype(np.float32) for of in (places, normals))
        facing *= np.sign(np.einsum("nd,nd->n", facing, camera.eye - points))[:, None]
        clouds.append(PointCloud(points, facing.astype(np.float32), np.zeros(points.shape, np.uint8)))
    return Sighting(joined(clouds), masks, cameras)


def standing(human: HumanModels) -> tuple[BodySurface, Legs]:
    """The template as it stands."""
    body = body_surface(human, human.template.vertices.astype(np.float64))
    return body, legs_of(human, body.vertices)
