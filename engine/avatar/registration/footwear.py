"""Whether a person wears shoes, as the cloud has it, and the template in them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.registration.skin import Skin
from engine.body.cache import cached_arrays
from engine.body.garments.shoes import shod
from engine.body.garments.toe_cap import ToeCap, toe_cap
from engine.geometry.closest_points import closest_points
from engine.geometry.point_cloud import PointCloud
from engine.geometry.registration.nonrigid_registration import ElasticSurface, geometric_steps, lay_on_points

FOOT_REACH = 0.03
"""Metres from the feet within which points are of them, and beyond which a point's distance counts no more."""
STIFF_STEPS = geometric_steps(3, (1e-4, 1e-7), (1.0, 1.0), (0.05, 0.02))
"""In which feet go where the points are and are bent a little: toes stay toes."""
MIN_POINTS = 60
"""Points about the toes with which a cloud says what they are in."""
MIN_ADVANTAGE = 0.0007
"""Metres by which points must be nearer to shoes than to bare toes, in the mean."""


@dataclass(frozen=True)
class Feet:
    """Masks (S,) of both feet, and the caps in which their shoes end."""

    masks: tuple[NDArray[np.bool_], NDArray[np.bool_]]
    caps: tuple[ToeCap, ToeCap]


def load_feet(skin: Skin, mean: NDArray[np.floating]) -> Feet:
    """The feet of the skin, whose mean body at rest is `mean` (S, 3); the first time, caps are made (some seconds)."""
    left, right = (skin.regions["feet"] & (sign * mean[:, 0] > 0) for sign in (1, -1))

    def convert() -> dict[str, np.ndarray]:
        made = [toe_cap(mean, skin.triangles, mask) for mask in (left, right)]
        return {f"{name}_{k}": getattr(cap, name) for k, cap in enumerate(made) for name in ("rim", "inside", "disk")}

    stored = cached_arrays("toe-caps", convert)
    first, second = (ToeCap(stored[f"rim_{k}"], stored[f"inside_{k}"], stored[f"disk_{k}"]) for k in (0, 1))
    return Feet((left, right), (first, second))


def in_shoes(skin: Skin, feet: Feet, vertices: NDArray[np.float64]) -> NDArray[np.float64]:
    """The skin (S, 3) in shoes."""
    return shod(vertices, skin.triangles, feet.masks, feet.caps)


def wears_shoes(skin: Skin, feet: Feet, bare: NDArray[np.float64], cloud: PointCloud) -> bool:
    """Whether the cloud's points about the toes are nearer to shoes than to bare toes, of the skin `bare` (S, 3), once either has
    been laid on them a little."""
    toes = np.zeros(len(bare), np.bool_)
    for cap in feet.caps:
        toes[cap.inside] = toes[cap.rim] = True
    covered = in_shoes(skin, feet, bare)
    whole = feet.masks[0] | feet.masks[1]
    near = _about(cloud, bare[whole])
    if len(near) < MIN_POINTS:
        return False
    at_toes = _about(near, np.concatenate([bare[toes], covered[toes]]))
    if len(at_toes) < MIN_POINTS:
        return False
    triangles = skin.triangles[toes[skin.triangles].any(1)]
    laid = [_laid(skin, whole, shape, near) for shape in (bare, covered)]
    distances = [closest_points(at_toes.points, shape, triangles).distance for shape in laid]
    about = np.minimum(*distances) < FOOT_REACH
    means = [float(np.minimum(distance[about], FOOT_REACH).mean()) for distance in distances]
    return bool(about.sum() >= MIN_POINTS and means[1] < means[0] - MIN_ADVANTAGE)


def _about(cloud: PointCloud, places: NDArray[np.float64]) -> PointCloud:
    """The points in the box of places (N, 3), and a little around."""
    return cloud[((cloud.points > places.min(0) - FOOT_REACH) & (cloud.points < places.max(0) + FOOT_REACH)).all(1)]


def _laid(skin: Skin, chosen: NDArray[np.bool_], shape: NDArray[np.float64], cloud: PointCloud) -> NDArray[np.float64]:
    """The skin `shape` (S, 3) with its `chosen` (S,) vertices laid on the cloud, but kept much as they are."""
    numbers = np.flatnonzero(chosen)
    triangles = np.searchsorted(numbers, skin.triangles[chosen[skin.triangles].all(1)])
    ones = np.ones(len(numbers))
    surface = ElasticSurface(shape[numbers], triangles, np.ones(len(triangles), np.bool_), ones, ones)
    out = shape.copy()
    out[numbers] = lay_on_points(surface, cloud.points, cloud.normals, STIFF_STEPS)
    return out
