"""What no camera sees of the head's skin, the mouth's inside and the sockets, brought along beneath what it sees."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.avatar.registration.template_skin.skin import Skin
from engine.geometry.deformation.smooth_field import smooth_field
from engine.geometry.mesh.closest_points import closest_points
from engine.geometry.mesh.winding_number import winding_numbers

LINING_DEPTH_METRES = 0.006
"""Metres below the visible skin down to which what is not seen goes with it, and keeps its depth; what is deeper goes along
smoothly."""
MIN_SKIN_DEPTH_METRES = 0.0015
"""Metres that the inside stays below the visible skin, at least, but where it comes up to its rim."""
MIN_TEMPLATE_DEPTH_SHARE = 0.5
"""Of the depth that it has in the template, which it keeps at least where that is less."""
CLAMPING_ROUNDS = 3
"""Rounds in which what sticks out of the mouth is brought below the skin that is nearest then."""


def inner_skin(skin: Skin, before: NDArray[np.floating], after: NDArray[np.floating]) -> NDArray[np.float64]:
    """The skin `after` (S, 3) the fit, with what is not seen of it set anew, from where it was `before` (S, 3).

    It is bound to the visible skin above it, a lip's to that of the same lip, and otherwise moves as smoothly as its rim asks for. None
    of it is outside, and none of a lip's in the other lip, where it hung below the lip as the mouth opens.
    """
    inner = skin.regions["inner"]
    was, now = np.asarray(before, np.float64), np.asarray(after, np.float64)
    linings = _linings(skin)
    moved, away = now - was, np.full(len(was), np.inf)
    for own, hull in linings:
        nearest = closest_points(was[own], was, hull)
        moved[own] = nearest.beneath(nearest.distance, now, hull) - nearest.beneath(nearest.distance, was, hull)
        away[own] = nearest.distance
    pull = np.where(inner, np.exp(-((away / LINING_DEPTH_METRES) ** 2)), 0)
    out = was + smooth_field(skin.triangles, inner, moved, pull)
    out[~inner] = now[~inner]
    least = np.minimum(MIN_SKIN_DEPTH_METRES, MIN_TEMPLATE_DEPTH_SHARE * away)
    for _ in range(CLAMPING_ROUNDS):
        for own, hull in linings:
            out[own] = brought_inside(out[own], out, hull, least[own])
    return out


def _linings(skin: Skin) -> list[tuple[NDArray[np.intp], NDArray[np.int32]]]:
    """What is not seen, by what it is below: the numbers of vertices, and the visible triangles above. Of a lip's those of the
    other lip are none."""
    inner, hull = skin.regions["inner"], skin.triangles[skin.visible]
    upper, lower = skin.regions["upper_lip"], skin.regions["lower_lip"]
    parts = [(inner & ~upper & ~lower, hull)]
    for own, other in ((upper, lower), (lower, upper)):
        parts.append((inner & own, hull[~other[hull].all(1)]))
    return [(np.flatnonzero(part), above) for part, above in parts]


def brought_inside(
    points: NDArray[np.float64],
    vertices: NDArray[np.float64],
    hull: NDArray[np.integer],
    depth: NDArray[np.float64],
) -> NDArray[np.float64]:
    """The points (N, 3), those that are not `depth` (N,) metres inside the surface `hull` (T, 3) over `vertices` (V, 3) moved to
    so far below its nearest point."""
    nearest = closest_points(points, vertices, hull)
    inside = winding_numbers(points, vertices, hull) > 0.5
    shallow = ~inside | (nearest.distance < depth)
    out = points.copy()
    out[shallow] = nearest[shallow].beneath(depth[shallow], vertices, hull)
    return out
