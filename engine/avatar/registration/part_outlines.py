"""How far the outline of a part of the body, as views show it, is off the outlines of the person there.

Where silhouettes end is known in every frame, from all around; points of stereo are few at feet and stand off them, and of a head under
a helmet no landmark tells.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.camera import Camera
from engine.imaging.masks.mask_distance import dilate_mask, distance_inside, distance_to
from engine.render.rasterisation.rasteriser import barycentrics_at, triangle_map
from engine.render.textures.sampling import bilinear

OUTLINE_REACH_METRES = 0.12
"""Metres around a part within which its outline may be."""
BODY_COVER_PIXELS = 2
"""From what else a view shows of the body, within which an outline is not the part's alone."""
MIN_OUTLINE_PIXELS = 12
"""Of a view about a part, along both sides: fewer tell nothing."""

Moved = Callable[[NDArray[np.float64], NDArray[np.float64]], NDArray[np.float64]]
"""Where places (M, 3) of the part at rest are for parameters (N, P): (N, M, 3)."""


@dataclass(frozen=True)
class Silhouette:
    """The person's `mask` (H, W) bool as a `camera` of its size sees them."""

    mask: NDArray[np.bool_]
    camera: Camera


@dataclass(frozen=True)
class PartSight:
    """What a silhouette has about a part of the body.

    camera : of that part of the picture.
    outside : (h, w, 1) metres at the part that each pixel is outside the mask, negative within, 0 along its own rim.
    beside : (h, w) where the rest of the body is.
    """

    camera: Camera
    outside: NDArray[np.float32]
    beside: NDArray[np.bool_]


@dataclass(frozen=True)
class OutlinePoints:
    """Points of a part on its outline in one sight: the `places` (M, 3) of the part at rest."""

    sight: PartSight
    places: NDArray[np.float64]

    def off(self, moved: Moved, parameters: NDArray[np.float64]) -> NDArray[np.float64]:
        """(N, M) metres by which they are outside of the person's silhouette, for parameters (N, P)."""
        where = moved(self.places, parameters)
        pixels = self.sight.camera.project(where.reshape(-1, 3))
        return np.asarray(bilinear(self.sight.outside, pixels), np.float64).reshape(where.shape[:2])


def part_sights(
    silhouettes: Sequence[Silhouette],
    part: NDArray[np.floating],
    body: NDArray[np.floating],
    triangles: NDArray[np.integer],
) -> list[PartSight]:
    """What silhouettes have about a part's places (F, 3), beside the rest of the `body` (S, 3), its `triangles` (T, 3) without the
    part's."""
    corners = np.stack(
        np.meshgrid(*np.stack([part.min(0) - OUTLINE_REACH_METRES, part.max(0) + OUTLINE_REACH_METRES], 1)), -1
    ).reshape(-1, 3)
    found = []
    for one in silhouettes:
        if one.camera.depth(corners).min() <= 0:
            continue
        seen = one.camera.project(corners)[:, :2]
        height, width = one.camera.size
        left, top = np.clip(np.floor(seen.min(0)), 0, [width, height]).astype(int).tolist()
        right, bottom = np.clip(np.ceil(seen.max(0)) + 1, 0, [width, height]).astype(int).tolist()
        if min(right - left, bottom - top) < MIN_OUTLINE_PIXELS:
            continue
        camera = one.camera.cropped(left, top, (bottom - top, right - left))
        pixel = float(camera.depth(part.mean(0))) / camera.focal
        mask = one.mask[top:bottom, left:right]
        if not mask.any():
            continue
        outside = pixel * np.where(mask, 1 - distance_inside(mask), distance_to(mask))
        rest = triangle_map(camera.project(body), triangles, camera.size, perspective=True) >= 0
        found.append(PartSight(camera, outside[..., None].astype(np.float32), dilate_mask(rest, BODY_COVER_PIXELS)))
    return found


def outline_points(
    sight: PartSight, vertices: NDArray[np.float64], triangles: NDArray[np.integer], rest: NDArray[np.float64]
) -> OutlinePoints:
    """A part's points on its outline in a sight, where that ends neither at the rest of the body nor at the picture's
    border. The part has `vertices` (F, 3) where it is and `rest` (F, 3) at rest."""
    seen = sight.camera.project(vertices)
    triangle = triangle_map(seen, triangles, sight.camera.size, perspective=True)
    shown = triangle >= 0
    rim = shown & dilate_mask(~shown, 1) & ~sight.beside
    rim[[0, -1]] = rim[:, [0, -1]] = False
    corners = triangles[triangle[rim]]
    shares = barycentrics_at(seen, corners, np.argwhere(rim), perspective=True).astype(np.float64)
    return OutlinePoints(sight, np.einsum("mk,mkc->mc", shares, rest[corners]))
