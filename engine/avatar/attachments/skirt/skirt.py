"""Cloth that hangs around both legs: how far out it is on each side, and where it ends.

Silhouettes show such cloth before and behind the gap between the legs, where it stands off the skin; beside a leg it lies on it, or nearly. It is one
ring all the same. So it is measured from the axis between the legs, from which on silhouettes have room as far as the cloth: a level curve for each height, and one
smooth curve around the body for its hem.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from engine.avatar.attachments.body_surface import BodySurface
from engine.avatar.attachments.silhouettes import Silhouettes
from engine.avatar.attachments.skirt.legs import Legs
from engine.avatar.attachments.standing_off import MAX_WORN_METRES, MIN_STANDING_OFF_METRES
from engine.geometry.point_clouds.point_cloud import PointCloud

TURN_COUNT = 96
"""Directions around the axis."""
LEVEL_STEP_METRES, RADIUS_STEP_METRES = 0.008, 0.01
"""Metres between heights, and between places along a direction, at which silhouettes are asked."""
TOP_METRES = 0.12
"""Metres above the crotch up to which cloth that goes around both legs is told from the skin."""
MIN_DROP_METRES = 0.03
"""Metres below the crotch that cloth goes down to at least: above are the seats of trousers."""
AHEAD_AND_BACK = (np.pi / 2, -np.pi / 2)
"""The two directions, radians from the left, in which the gap between the legs opens."""
GAP_DEGREES = 30.0
"""Degrees to both sides of straight ahead, and of straight back, within which cloth shows in the gap between legs."""
MIN_GAP_SHARE = 0.5
"""Of the directions to the gap, before the legs and behind them, in which cloth hangs where it goes around both: coats without a
front, and tails, do not."""
MIN_CLOTH_POINTS = 20
"""Points of the cloud in the gap before the legs, and as many behind them, that must be there to tell whether what hangs there is cloth."""
HOLLOW_DEPTH_METRES = 0.02
"""Metres within what silhouettes have room for from which on points are at the end of a hollow: silhouettes fill the gap before tails."""
HEM_WAVES, HEM_LEVELLING = 2, 2.0
"""Waves around the body of which a hem consists, and directions' worth of belief that it is level: beside a leg nothing tells of it."""
HEM_ERROR_METRES, HEM_ROUNDS = 0.008, 10
"""Metres by which a direction's hem is off, as a rule, beyond which it counts less, and rounds of reweighted least squares."""
INNER_SHARE = 0.6
"""Of the way out to the skin of the hips within which nothing is asked of the room below: a slanted hem shows the light between legs."""
HIDDEN_BELOW_METRES = 0.06
"""Metres below a hem down to which the cloth before hides what is between legs from cameras above."""
CURVE_BLUR_TURNS, CURVE_BLUR_HEIGHTS = 1.5, 2.0
"""Directions and heights of the Gaussian over how far out cloth is."""
HEM_MARGIN_METRES = 0.01
"""Metres above the hem up to which outlines of the cloth are rounded off by masks."""


@dataclass(frozen=True)
class Skirt:
    """Cloth around both legs, by A directions around `legs.axis`, counted from the left over the front, and K heights.

    legs : the legs.
    turns : (A,) radians.
    heights : (K,) metres, from the lowest hem up.
    radii : (A, K) metres from the axis to the cloth's outside.
    skin : (A, K) metres from the axis to the skin's outside, or to the axis itself where there is none.
    hem : (A,) the height, metres, at which it ends.
    """

    legs: Legs
    turns: NDArray[np.float64]
    heights: NDArray[np.float64]
    radii: NDArray[np.float64]
    skin: NDArray[np.float64]
    hem: NDArray[np.float64]

    def within(self, points: NDArray[np.floating]) -> NDArray[np.bool_]:
        """(N,) whether points (N, 3) are between its hem and its top, and not outside of it: cloth, legs, and what is between, with the
        room below its hem that it hides from cameras that look down."""
        hem, depth = self._beside(points)
        level = (points[:, 1] > hem - HIDDEN_BELOW_METRES) & (points[:, 1] < self.heights[-1])
        return np.asarray(level & (depth > -MIN_STANDING_OFF_METRES))

    def is_cloth(self, points: NDArray[np.floating]) -> NDArray[np.bool_]:
        """(N,) whether points (N, 3) are of the cloth below the crotch, which is no skin."""
        hem, depth = self._beside(points)
        level = (points[:, 1] > hem - MIN_STANDING_OFF_METRES) & (points[:, 1] < self.legs.crotch)
        return np.asarray(level & (np.abs(depth) < HOLLOW_DEPTH_METRES))

    def _beside(self, points: NDArray[np.floating]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(N,) the hem's height where points (N, 3) are, and (N,) metres by which they are nearer to the axis than its outside."""
        off = points[:, [0, 2]] - self.legs.axis
        left, ahead = directions(self.legs, np.array([0, np.pi / 2]))
        turn = np.arctan2(off @ ahead, off @ left)
        column = turn / (2 * np.pi) * len(self.turns) % len(self.turns)
        row = np.clip((points[:, 1] - self.heights[0]) / LEVEL_STEP_METRES, 0, len(self.heights) - 1)
        closed = np.concatenate([self.radii, self.radii[:1]])
        radius = ndimage.map_coordinates(closed, [column, row], order=1)
        hem = np.interp(turn, self.turns, self.hem, period=2 * np.pi)
        return np.asarray(hem), np.asarray(radius - np.linalg.norm(off, axis=1))


def directions(legs: Legs, turns: NDArray[np.floating]) -> NDArray[np.float64]:
    """(A, 2) unit vectors along x and z in `turns` (A,), radians from the left over the front."""
    ahead = np.array([-legs.left[1], legs.left[0]])
    return np.cos(turns)[:, None] * legs.left + np.sin(turns)[:, None] * ahead


def skirt_around(body: BodySurface, legs: Legs, silhouettes: Silhouettes, cloud: PointCloud) -> Skirt | None:
    """The cloth that silhouettes have around both legs of a body, where the `cloud` has none of the legs within; None where nothing goes
    around both."""
    turns = 2 * np.pi * np.arange(TURN_COUNT) / TURN_COUNT
    heights = np.arange(legs.soles, legs.crotch + TOP_METRES, LEVEL_STEP_METRES)
    ways = directions(legs, turns)
    gaps = [np.flatnonzero(np.cos(turns - ahead) > np.cos(np.radians(GAP_DEGREES))) for ahead in AHEAD_AND_BACK]
    lowest = np.inf
    for first in (legs.crotch - 2 * MIN_DROP_METRES, legs.soles):
        for gap in gaps:
            rays = _Rays.cast(body, silhouettes, legs, ways[gap], heights[heights > first])
            drop = rays.lowest_cloth(legs.crotch)
            hangs = drop < legs.crotch - MIN_DROP_METRES
            if hangs.mean() < MIN_GAP_SHARE or not _is_outside(
                cloud, legs, turns[gap], rays, float(np.median(drop[hangs]))
            ):
                return None
            lowest = min(lowest, float(drop.min()))
    rays = _Rays.cast(body, silhouettes, legs, ways, heights[heights > lowest - MIN_DROP_METRES])
    hem = smooth_hem(turns, rays.lowest_cloth(legs.crotch), legs.crotch - MIN_DROP_METRES)
    kept = rays.heights > hem.min() - LEVEL_STEP_METRES
    rounded = rays.heights < hem[:, None] + HEM_MARGIN_METRES
    radii = _smooth(np.where(rounded | ~rays.open, np.nan, rays.radii))
    return Skirt(legs, turns, rays.heights[kept], radii[:, kept], rays.skin[:, kept], hem)


def _is_outside(cloud: PointCloud, legs: Legs, turns: NDArray[np.float64], rays: _Rays, lowest: float) -> bool:
    """Whether most points of the `cloud` in the directions `turns` of `rays`, from the crotch down to the `lowest` cloth there, are on what
    silhouettes have room for, and not in a hollow of it."""
    off = cloud.points[:, [0, 2]] - legs.axis
    radius = np.linalg.norm(off, axis=1)
    nearest = (off / np.maximum(radius, 1e-9)[:, None]) @ directions(legs, turns).T
    column = nearest.argmax(1)
    row = np.rint((cloud.points[:, 1] - rays.heights[0]) / LEVEL_STEP_METRES).astype(np.intp)
    level = (cloud.points[:, 1] > lowest) & (row >= 0) & (cloud.points[:, 1] < legs.crotch)
    inside = level & (nearest.max(1) > np.cos(2 * np.pi / TURN_COUNT))
    depth = rays.radii[column[inside], np.minimum(row[inside], len(rays.heights) - 1)] - radius[inside]
    return len(depth) >= MIN_CLOTH_POINTS and float(np.median(depth)) < HOLLOW_DEPTH_METRES


@dataclass(frozen=True)
class _Rays:
    """What is met on the way out from the axis in A directions at K heights.

    heights : (K,) metres.
    radii : (A, K) metres to where silhouettes have no more room.
    open : (A, K) bool, whether there is room up to there, and no arm.
    skin : (A, K) metres to where the skin was left last.
    off : (A, K) metres from the skin to what is just within `radii`.
    """

    heights: NDArray[np.float64]
    radii: NDArray[np.float64]
    open: NDArray[np.bool_]
    skin: NDArray[np.float64]
    off: NDArray[np.float64]

    @classmethod
    def cast(
        cls,
        body: BodySurface,
        silhouettes: Silhouettes,
        legs: Legs,
        ways: NDArray[np.float64],
        heights: NDArray[np.float64],
    ) -> _Rays:
        lengths = np.arange(0, legs.apart + MAX_WORN_METRES, RADIUS_STEP_METRES)
        shape = (len(ways), len(heights), len(lengths))
        level = legs.axis + lengths[:, None] * ways[:, None]
        places = np.empty((*shape, 3))
        places[..., 1] = heights[:, None]
        places[..., [0, 2]] = level[:, None]
        flat = places.reshape(-1, 3)
        room = silhouettes.depths(flat, np.zeros(len(flat), np.bool_)).reshape(shape)
        hips = np.median(_first(room <= 0)[:, heights >= legs.crotch], axis=1)
        begin = (INNER_SHARE * hips).astype(np.intp)[:, None]
        ends = _first((room <= 0) & (np.arange(len(lengths)) >= begin[..., None]))
        first = np.maximum(ends - 1, 0)
        inner, outer = (np.take_along_axis(room, at[..., None], 2)[..., 0] for at in (first, ends))
        share = np.clip(inner / np.maximum(inner - outer, 1e-9), 0, 1)
        radii = lengths[first] + share * (lengths[ends] - lengths[first])
        asked = np.arange(len(lengths)) < ends[..., None]
        away, arm = np.full(shape, np.inf), np.zeros(shape, np.bool_)
        away[asked] = body.without_own().distances(places[asked])
        arm[asked] = body.own[body.nearest(places[asked])]
        met = np.where(arm.any(2), arm.argmax(2), len(lengths))
        within = (away < 0) & (np.arange(len(lengths)) < met[..., None])
        skin = np.where(within.any(2), lengths[len(lengths) - 1 - within[..., ::-1].argmax(2)], 0)
        off = np.take_along_axis(away, first[..., None], 2)[..., 0]
        return cls(heights, radii, (ends > begin) & (met > ends), skin, off)

    def lowest_cloth(self, crotch: float) -> NDArray[np.float64]:
        """(A,) the height down to which cloth hangs from the `crotch` on, +inf where none does. Cameras look down, and hide below a hem what they
        have no room for farther out: there outlines recede faster than they go down."""
        below = np.flatnonzero(self.heights < crotch - LEVEL_STEP_METRES)[::-1]
        cloth = (self.open & (self.off > MIN_STANDING_OFF_METRES))[:, below]
        cloth[:, 1:] &= np.diff(self.radii[:, below], axis=1) > -LEVEL_STEP_METRES
        rows = np.logical_and.accumulate(cloth, axis=1).sum(1)
        return np.where(rows > 0, self.heights[below[np.maximum(rows - 1, 0)]], np.inf)


def _first(there: NDArray[np.bool_]) -> NDArray[np.intp]:
    """(A, K) which of M places along each ray, (A, K, M), is the first that is `there`; the last one where none is."""
    return np.where(there.any(2), there.argmax(2), there.shape[2] - 1)


def smooth_hem(turns: NDArray[np.float64], lowest: NDArray[np.float64], highest: float) -> NDArray[np.float64]:
    """(A,) the height of a hem in directions `turns` (A,), by those in which cloth is seen to end (`lowest` (A,), below `highest`)."""
    waves = np.arange(1, HEM_WAVES + 1)
    basis = np.concatenate([np.ones((len(turns), 1)), *(f(np.outer(turns, waves)) for f in (np.cos, np.sin))], 1)
    known = lowest < highest
    told, shape = lowest[known], basis[known]
    level = HEM_LEVELLING * np.diag([0.0] + [1.0] * (2 * HEM_WAVES))
    weights = np.ones(len(told))
    middle = float(np.median(told))
    for _ in range(HEM_ROUNDS):
        normal = shape.T @ (weights[:, None] * shape) + level
        found = np.linalg.solve(normal, shape.T @ (weights * (told - middle)))
        weights = 1 / (1 + ((told - middle - shape @ found) / HEM_ERROR_METRES) ** 2)
    return np.asarray(middle + basis @ found)


def _smooth(radii: NDArray[np.float64]) -> NDArray[np.float64]:
    """(A, K) radii, (A, K), smoothly over what is not known (NaN)."""
    known = np.isfinite(radii).astype(np.float64)
    sigma = (CURVE_BLUR_TURNS, CURVE_BLUR_HEIGHTS)
    values = np.where(known > 0, radii, 0)
    out, reached = np.zeros_like(values), np.zeros_like(values)
    while (reached == 0).any():  # wider, where nothing near is known
        near = ndimage.gaussian_filter(known, sigma, mode=("wrap", "nearest"))
        far = ndimage.gaussian_filter(values, sigma, mode=("wrap", "nearest"))
        some = (reached == 0) & (near > 1e-3)
        out[some], reached[some] = far[some] / near[some], 1
        sigma = (2 * sigma[0], 2 * sigma[1])
    return out
