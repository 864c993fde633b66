"""Feet in shoes: a shoe's own smooth shape, closed over the toes, its sole flat.

Bare toes that are laid on a shoe become claws. A shoe is made on a last. Its shape is given here as curves along its
length. The skin of a foot is carried onto it along rays from an axis within the foot. So the vertices stay the
template's, and nothing else need know.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from engine.body.garments.toe_cap import ToeCap
from engine.geometry.mesh.surface import vertex_normals

SHOE_LENGTH_RATIO, SHOE_WIDTH_RATIO = 1.09, 1.15
"""Of a shoe, in lengths and widths of the foot in it."""
HEEL_ROOM = 0.3
"""Of what a shoe is longer than the foot, how much is behind the heel."""
STATION_SHARES = np.array([0.0, 0.15, 0.3, 0.45, 0.6, 0.72, 0.85, 1.0])
"""Where along a shoe, in its lengths from the heel, the curves of the last are given."""
HALF_WIDTHS = np.array([0.34, 0.34, 0.34, 0.37, 0.46, 0.5, 0.5, 0.47])
"""Half a shoe's width at `STATION_SHARES`, in its greatest width."""
STATION_HEIGHTS = np.array([0.38, 0.38, 0.36, 0.31, 0.26, 0.235, 0.225, 0.22])
"""A shoe's height at `STATION_SHARES`, in its length. At the back it reaches higher than the shoe's rim, where the
ankle is."""
HEEL_ROUND, TOE_ROUND = (0.14, 2.4), (0.34, 2.3)
"""How far from heel and tip, in its length, a shoe is rounded, and the exponents of the superellipses by which it
is."""
TOE_BOX = (0.26, 2.4)
"""Where a shoe's height begins to round off before the toes, as a share of its length, and the exponent of that
superellipse."""
SOLE_EXPONENT, UPPER_EXPONENT = 5.0, 2.4
"""Exponents of the superellipses of a shoe's cross-sections, below and above half their height."""
TOE_SPRING = 0.03
"""By how much of its length the sole's tip is above the ground, from the ball on."""
SOLE_HEIGHTS = (0.1, 0.065)
"""How thick the sole is at the heel and at the tip, in a shoe's length."""
WELT = 0.012
"""How far the sole stands out beyond the upper, all round, in a shoe's length."""
WELT_SLOPE = 0.05
"""Over how much of its length above the sole the upper draws in."""
SHANK, SHANK_RISE = (0.27, 0.56), 0.026
"""Where, in a shoe's length from the heel, its sole is above the ground between heel and ball, and by how much of it."""
SHOE_AXIS = np.array([[0.0, 0.12, 0.16], [0.0, 0.055, 0.8]])
"""Both ends of the axis within a shoe, from which rays lead: aside, above the ground and along it, in its length."""
SHOE_COLLAR_FOOT_LENGTHS = (0.16, 0.27)
"""Heights above the ground, in lengths of the foot: up to the first all is shoe, from the second on none is."""
SOCK_METRES = 0.004
"""Metres of cloth on a foot above its shoe."""


def shod(
    vertices: NDArray[np.floating],
    triangles: NDArray[np.integer],
    feet: Sequence[NDArray[np.bool_]],
    caps: Sequence[ToeCap],
) -> NDArray[np.float64]:
    """The skin (S, 3) at rest, standing with y up and facing +z, with both `feet` (S,) in shoes that close over `caps`."""
    out = np.array(vertices, np.float64)
    normals = vertex_normals(out, triangles)
    for foot, cap in zip(feet, caps, strict=True):
        out[foot] = _shoe(out, normals, foot, cap)[foot]
    return out


def _shoe(
    vertices: NDArray[np.float64], normals: NDArray[np.floating], foot: NDArray[np.bool_], cap: ToeCap
) -> NDArray[np.float64]:
    """(S, 3) the skin, its vertices of the foot on the shoe."""
    origin, axes = _foot_axes(vertices, foot, cap)
    local = (vertices - origin) @ axes.T
    least, most = local[foot].min(0), local[foot].max(0)
    foot_length, foot_width = most[2] - least[2], most[0] - least[0]
    length, width = SHOE_LENGTH_RATIO * foot_length, SHOE_WIDTH_RATIO * foot_width
    back = np.array([(least[0] + most[0]) / 2, 0.0, least[2] - HEEL_ROOM * (length - foot_length)])
    local = (local - back) / length
    starts, ways = _rays(local, cap)
    reached = starts + _reach(starts, ways, width / length)[:, None] * ways
    shoe = (reached * length + back) @ axes + origin
    low, high = SHOE_COLLAR_FOOT_LENGTHS
    share = np.clip((local[:, 1] * length / foot_length - low) / (high - low), 0, 1)
    share = (share * share * (3 - 2 * share))[:, None]
    return np.asarray(shoe + share * (vertices + SOCK_METRES * normals - shoe))


def _foot_axes(
    vertices: NDArray[np.float64], foot: NDArray[np.bool_], cap: ToeCap
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The middle of the foot on the ground (3,), and its axes as rows (3, 3): to its left, up, ahead."""
    own = vertices[foot]
    ground = own[:, 1].min()
    low = own[own[:, 1] < ground + 0.3 * np.ptp(own[:, 1])]
    ahead = (vertices[cap.inside].mean(0) - low[low[:, 2] < np.quantile(low[:, 2], 0.15)].mean(0)) * [1, 0, 1]
    ahead /= np.linalg.norm(ahead)
    up = np.array([0.0, 1.0, 0.0])
    middle = own.mean(0) * [1, 0, 1] + ground * up
    return middle, np.stack([np.cross(up, ahead), up, ahead])


def _rays(local: NDArray[np.float64], cap: ToeCap) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(S, 3) points of the axis and (S, 3) unit ways from there through the foot's vertices; those of toes fan out before the
    axis' end, as they lie on the cap's disk."""
    heel, tip = SHOE_AXIS
    along = tip - heel
    rim = local[cap.rim]
    last = np.clip(((rim - heel) @ along).max() / (along @ along), 0, 1)
    share = np.clip((local - heel) @ along / (along @ along), 0, last)
    starts = heel + share[:, None] * along
    ways = local - starts
    ways /= np.maximum(np.linalg.norm(ways, axis=1, keepdims=True), 1e-9)
    radius = np.minimum(np.linalg.norm(cap.disk, axis=1), 1) * np.pi / 2
    turn = np.mod(np.arctan2(cap.disk[:, 1], cap.disk[:, 0]), 2 * np.pi)
    lengths = np.linalg.norm(np.roll(rim, -1, 0) - rim, axis=1)
    stations = 2 * np.pi * np.concatenate([[0], np.cumsum(lengths)]) / lengths.sum()
    closed = np.concatenate([cap.rim, cap.rim[:1]])
    starts_of_rim, ways_of_rim = (
        np.stack([np.interp(turn, stations, of[closed, axis]) for axis in range(3)], 1) for of in (starts, ways)
    )
    ahead, aside = np.cos(radius)[:, None], np.sin(radius)[:, None]
    starts[cap.inside] = starts_of_rim + ahead * (tip - starts_of_rim)
    fan = aside * ways_of_rim + ahead * np.array([0.0, 0.0, 1.0])
    ways[cap.inside] = fan / np.linalg.norm(fan, axis=1, keepdims=True)
    return starts, ways


def _reach(starts: NDArray[np.float64], ways: NDArray[np.float64], width: float) -> NDArray[np.float64]:
    """(S,) how far from points within a last of length 1 rays leave it."""
    near, far = np.zeros(len(starts)), np.ones(len(starts))
    for _ in range(40):
        middle = (near + far) / 2
        within = _within_last(starts + middle[:, None] * ways, width)
        near, far = np.where(within, middle, near), np.where(within, far, middle)
    return near


def _within_last(places: NDArray[np.float64], width: float) -> NDArray[np.bool_]:
    """(N,) whether places (N, 3) are in a last of length 1 and a greatest `width`, its heel's end at the origin."""
    x, y, z = places.T
    inside = (z > 0) & (z < 1)
    z = np.clip(z, 0, 1)
    ground = sole_bottom(z)
    drawn_in = WELT * np.clip((y - ground - sole_thickness(z)) / WELT_SLOPE, 0, 1)
    heel, tip = _rounded(z - drawn_in, *HEEL_ROUND), _rounded(1 - z - drawn_in, *TOE_ROUND)
    aside = np.interp(z, STATION_SHARES, HALF_WIDTHS) * width * heel * tip - drawn_in
    high = np.interp(z, STATION_SHARES, STATION_HEIGHTS) * _rounded(1 - z - drawn_in, *TOE_BOX)
    across = np.abs(x) / np.maximum(aside, 1e-9)
    rise = (y - ground) / np.maximum(high / 2, 1e-9) - 1
    exponent = np.where(rise < 0, SOLE_EXPONENT, UPPER_EXPONENT)
    return np.asarray(inside & (across**exponent + np.abs(rise) ** exponent < 1))


def sole_bottom(along: NDArray[np.floating]) -> NDArray[np.float64]:
    """How high (N,) the ground's side of a sole is at places (N,) from heel, 0, to tip, 1, in a shoe's length: a heel stands, and a ball;
    the shank between them and the tip do not."""
    first, last = SHANK
    arch = np.sin(np.pi * np.clip((along - first) / (last - first), 0, 1)) ** 2
    return np.asarray(SHANK_RISE * arch + TOE_SPRING * np.clip((along - 0.75) / 0.25, 0, 1) ** 2)


def sole_thickness(along: NDArray[np.floating]) -> NDArray[np.float64]:
    """How thick (N,) a sole is at places (N,) from heel, 0, to tip, 1, in a shoe's length."""
    return np.interp(along, [0, 1], SOLE_HEIGHTS)


def _rounded(away: NDArray[np.float64], reach: float, exponent: float) -> NDArray[np.float64]:
    """What remains of a width so far `away` from an end that is rounded over `reach`: a superellipse."""
    missing = np.clip(1 - away / reach, 0, 1)
    return np.asarray((1 - missing**exponent) ** (1 / exponent))
