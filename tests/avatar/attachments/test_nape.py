"""Hair ends at the nape, wherever outlines have room down to the collar."""

from __future__ import annotations

import numpy as np

from engine.avatar.attachments.attaching import body_surface
from engine.avatar.attachments.seen_around import SeenAround
from engine.avatar.attachments.silhouettes import silhouettes_beside
from engine.avatar.attachments.solid import GRID_SPACING_METRES, NAPE_REACH_METRES, SOLID_REACH_METRES, solid
from engine.avatar.attachments.standing_off import VOLUME_SPACING_METRES, StandingPiece
from engine.avatar.registration.models import load_models
from engine.body.rest_pose import t_pose
from engine.geometry.camera import Camera
from engine.geometry.multiview.free_space import SeenSurfaces
from engine.geometry.point_clouds.point_cloud import PointCloud

BUN_METRES = 0.05
"""Radius of a bun low on the back of the head."""


def test_a_bun_does_not_go_down_the_neck() -> None:
    human = load_models()
    template = human.template
    vertices = t_pose(human.rig, template.vertices, template.vertices_of("body"))[2].astype(np.float64)
    body = body_surface(human, vertices)
    head = body.vertices[body.head]
    nape = head[np.argmin(head[:, 1] + head[:, 2])]
    middle = nape + np.array([0, 0.045, -0.02])
    steps = np.arange(-BUN_METRES, BUN_METRES, VOLUME_SPACING_METRES)
    bun = middle + np.stack(np.meshgrid(steps, steps, steps), -1).reshape(-1, 3)
    bun = bun[(np.linalg.norm(bun - middle, axis=1) < BUN_METRES) & (body.distances(bun) > 0.012)]
    lens = Camera((0.0, 0.0, 0.0), 100.0, (49.5, 49.5), (100, 100))
    cameras = [lens.aimed(list(middle + np.array([x, 0.0, z])), list(middle)) for x, z in ((0, 2), (2, 0), (0, -2))]
    masks = [np.ones((100, 100), np.bool_)] * 3  # there is room everywhere
    empty = SeenSurfaces(cameras, [np.full((100, 100), np.inf, np.float32)] * 3)
    nothing = PointCloud(*(np.zeros((0, 3), kind) for kind in (np.float32, np.float32, np.uint8)))
    piece = StandingPiece(bun, np.zeros(len(body.vertices), np.bool_))
    found, _ = solid(piece, body, silhouettes_beside(body, masks, cameras), SeenAround(empty, empty), nothing)
    away = np.sqrt(((found[:, None] - bun[None]) ** 2).sum(2).min(1))
    outside = body.distances(found) > 0
    beside_neck = outside & ~body.beside_head(found)
    assert beside_neck.any()
    assert np.median(away[beside_neck]) < NAPE_REACH_METRES + 2 * GRID_SPACING_METRES  # its end is blurred over 12 mm
    assert away[beside_neck].max() < SOLID_REACH_METRES - GRID_SPACING_METRES
    assert away[outside & ~beside_neck].max() > SOLID_REACH_METRES - GRID_SPACING_METRES
