"""Whether a person wears shoes, and the template in them.

Who is filmed wears shoes unless feet are seen to be bare: no cloud of feet, as small films have none, is no evidence of toes.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.avatar.registration.template_skin.skin import Skin
from engine.body.cache import cached_arrays
from engine.body.garments.shoes import shod
from engine.body.garments.toe_cap import ToeCap, toe_cap
from engine.geometry.point_clouds.point_cloud import PointCloud

FOOT_REACH_METRES = 0.02
"""Metres from the coarse fit's feet within which points are of them."""
SHOE_FLOOR_REACH_METRES = 0.012
"""Metres above a foot's lowest points below which points may be the floor's."""
NOSE_LANDMARKS = slice(27, 36)
"""Of the 68 face landmarks: about them there is skin, and no hair."""
NOSE_REACH_METRES = 0.015
"""Metres about the nose's landmarks within which there is skin."""
MIN_COLOUR_POINTS = 60
"""Points of feet, and of the face, with which colours are known."""
MAX_FOOT_HUE_DISTANCE = 9.0
"""By how much, in the plane of CIELAB's a and b, the skin of feet differs from the face's, at most."""
MIN_LIGHTNESS_RATIO, MAX_LIGHTNESS_RATIO = 0.6, 1.5
"""How light the skin of feet is, in the face's lightness: at least, and at most."""
MIN_BARE_SHARE = 0.6
"""Of the points of feet, that have the colour of skin."""


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

    stored = cached_arrays("shoe-caps", convert)
    first, second = (ToeCap(stored[f"rim_{k}"], stored[f"inside_{k}"], stored[f"disk_{k}"]) for k in (0, 1))
    return Feet((left, right), (first, second))


def in_shoes(skin: Skin, feet: Feet, vertices: NDArray[np.floating]) -> NDArray[np.float64]:
    """The skin (S, 3) at rest in shoes."""
    return shod(vertices, skin.triangles, feet.masks, feet.caps)


def seen_barefoot(feet: Feet, coarse: NDArray[np.float64], cloud: PointCloud, face: NDArray[np.floating]) -> bool:
    """Whether the cloud's points about the feet of the `coarse` fit (S, 3) have the colours of those about the nose, of the landmarks
    `face` (68, 3), NaN where unknown. Where either are not seen, nobody was seen barefoot."""
    own = coarse[feet.masks[0] | feet.masks[1]]
    near = _about(cloud, own, FOOT_REACH_METRES)
    near = near[near.points[:, 1] > own[:, 1].min() + SHOE_FLOOR_REACH_METRES]
    nose = face[NOSE_LANDMARKS]
    nose = nose[np.isfinite(nose).all(1)]
    if not len(nose):
        return False
    skin = _about(cloud, nose, NOSE_REACH_METRES)
    if min(len(near), len(skin)) < MIN_COLOUR_POINTS:
        return False
    face_lab = np.median(_lab(skin), axis=0)
    lab = _lab(near)
    alike = np.linalg.norm(lab[:, 1:] - face_lab[1:], axis=1) < MAX_FOOT_HUE_DISTANCE
    alike &= (lab[:, 0] > MIN_LIGHTNESS_RATIO * face_lab[0]) & (lab[:, 0] < MAX_LIGHTNESS_RATIO * face_lab[0])
    return bool(alike.mean() > MIN_BARE_SHARE)


def _about(cloud: PointCloud, places: NDArray[np.floating], reach: float) -> PointCloud:
    """The points within `reach` of any of the places (N, 3)."""
    inside = ((cloud.points > places.min(0) - reach) & (cloud.points < places.max(0) + reach)).all(1)
    boxed = cloud[inside]
    distance = cKDTree(places).query(boxed.points, distance_upper_bound=reach)[0]
    return boxed[np.isfinite(distance)]


def _lab(cloud: PointCloud) -> NDArray[np.float32]:
    """(N, 3) the points' colours in CIELAB."""
    return np.asarray(cv2.cvtColor(cloud.colours[None].astype(np.float32) / 255, cv2.COLOR_RGB2LAB)[0])
