"""The joints of a drawn figure, from nothing but its outline.

The network of body poses knows photographs: a child's drawing, a stick man with a skirt, it does not see. But whoever draws
somebody gives them a head, two hands and two feet that stick out, and these are ends of the outline's medial axis (Blum, A
transformation for extracting new descriptors of shape, 1967). Among its ends the five are sought that look most like somebody
upright who faces the viewer: limbs alike in length, the head above where the arms meet, feet below where the legs do. Where their
ways along the axis meet are neck and crotch, and on these ways lie all other joints.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.imaging.masks.mask_pieces import largest_piece
from engine.perception.pose.body import BODY_LANDMARKS

OUTLINE_WORKING_PIXELS = 300
"""Pixels of the outline's longer side on which the axis is found."""
OUTLINE_SIGMA_SHARE = 0.008
"""Standard deviation, as a share of the outline's longer side, by which the outline is smoothed first: wobbly lines
have no limbs."""
MAX_ENDS = 11
"""Ends of the axis that are tried as head, hands and feet: those that stick out furthest."""
ROUND_RADII = 1.3
"""Radii of what is round within which ends of the axis are no more than its bumps: hair on a head, fingers of a hand."""
ROUND_WIDTH_RATIO = 1.3
"""How much wider than what is around it something is that is round."""
TIPS_APART = 0.06
"""How far ends are apart at least, as a share of the outline's longer side."""
MIN_LIMB, STICKS_OUT = 0.08, 1.5
"""Length of a limb on the axis, at least, as a share of the outline's longer side, and in radii of the largest disk
around the place where it leaves the trunk. The corners of a bar do not reach that far."""
MAX_SKELETON_COST = 1.2
"""Cost of the best choice above which the outline is nobody's."""
UNLIKE_COST, ASTRAY_COST, LEFT_OVER_COST = 0.5, 1.0, 3.0
"""Costs of what should not be. The first is of a limb e times as long as the other, or of an arm that leaves the trunk
a figure's size further down than the other. The second is of a head or of feet as far from the highest or lowest place
of the axis. The third is of using nothing of the axis."""
MIN_UPRIGHT_COSINE = 0.8
"""Cosine of the angle with the vertical from which on somebody is upright."""
MAX_LIMB_LENGTH_RATIO = 2.0
"""How many times as long as the other one arm, or leg, is at most."""
ELBOW_SHARE, WRIST_SHARE, KNEE_SHARE, ANKLE_SHARE = 0.48, 0.88, 0.5, 0.93
"""Where on its way from the shoulder or hip to the end a joint lies."""
EYE_OFFSET_RADII, EAR_OFFSET_RADII, MOUTH_OFFSET_RADII = 0.35, 0.8, 0.45
"""How far from the middle of the head eyes and ears lie, and the mouth beneath it, as shares of its radius."""


@dataclass(frozen=True)
class MedialAxis:
    """The axis of an outline.

    points : (N, 2) on it, x and y.
    radius : (N,) of the largest disk within the outline around each.
    graph : (N, N) how far neighbours are apart.
    """

    points: NDArray[np.float64]
    radius: NDArray[np.float64]
    graph: csr_matrix

    @cached_property
    def size(self) -> float:
        """Pixels of its longer side."""
        return float(np.ptp(self.points, axis=0).max())

    @cached_property
    def length(self) -> float:
        """Pixels of all its ways together."""
        return float(self.graph.sum()) / 2

    def lengths(self, way: NDArray[np.intp]) -> NDArray[np.float64]:
        """How far each of a way's places is from its beginning."""
        steps = np.linalg.norm(np.diff(self.points[way], axis=0), axis=1)
        return np.concatenate([[0], np.cumsum(steps)])

    @cached_property
    def rows(self) -> tuple[float, float]:
        """The highest and the lowest."""
        return float(self.points[:, 1].min()), float(self.points[:, 1].max())


@dataclass(frozen=True)
class _Ends:
    """Places on the axis that may be head, hands or feet.

    at : (E, 2) the points.
    apart : (E, E) how far they are apart on the axis.
    ways : from one to another, places on the axis from the first on.
    """

    at: NDArray[np.float64]
    apart: NDArray[np.float64]
    ways: Mapping[tuple[int, int], NDArray[np.intp]]


@dataclass(frozen=True)
class _Five:
    """Head, left and right hand, left and right foot, by their numbers among the ends. With them how far from the head,
    on its way to the left foot, arms leave the trunk and legs part."""

    head: int
    hands: tuple[int, int]
    feet: tuple[int, int]
    arms_leave: tuple[float, float]
    crotch: float


def outline_skeleton(mask: NDArray[np.bool_]) -> NDArray[np.float32] | None:
    """The landmarks `BODY_LANDMARKS` (33, 2), pixels, of whoever has the outline `mask` (H, W); None where it is nobody's who stands
    upright with head, hands and feet apart."""
    scale = OUTLINE_WORKING_PIXELS / max(mask.shape)
    size = (max(1, round(mask.shape[1] * scale)), max(1, round(mask.shape[0] * scale)))
    small = cv2.resize(mask.astype(np.float32), size, interpolation=cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR)
    smooth = cv2.GaussianBlur(small, (0, 0), OUTLINE_SIGMA_SHARE * OUTLINE_WORKING_PIXELS) > 0.5
    if not smooth.any():
        return None
    axis = medial_axis(largest_piece(smooth))
    ends = _ends(axis)
    five = _best_five(axis, ends)
    if five is None:
        return None
    marks = _landmarks(axis, ends, five)
    return np.asarray((np.stack([marks[name] for name in BODY_LANDMARKS]) + 0.5) / scale - 0.5, np.float32)


def medial_axis(mask: NDArray[np.bool_]) -> MedialAxis:
    """The axis of an outline (H, W), thinned to single pixels (Guo and Hall, 1989)."""
    padded = np.pad(mask, 1).astype(np.uint8)
    thin = cv2.ximgproc.thinning(padded * np.uint8(255), thinningType=cv2.ximgproc.THINNING_GUOHALL) > 0
    inside = cv2.distanceTransform(padded, cv2.DIST_L2, 5)
    ys, xs = np.nonzero(thin)
    number = np.full(thin.shape, -1)
    number[ys, xs] = np.arange(len(ys))
    rows, columns, lengths = [], [], []
    for dy, dx in ((0, 1), (1, 0), (1, 1), (1, -1)):
        other = number[ys + dy, xs + dx]
        # a diagonal beside a corner is no way of its own
        joined = (other >= 0) & ((dy * dx == 0) | ((number[ys + dy, xs] < 0) & (number[ys, xs + dx] < 0)))
        rows.append(np.flatnonzero(joined))
        columns.append(other[joined])
        lengths.append(np.full(int(joined.sum()), np.hypot(dy, dx)))
    a, b, length = (np.concatenate(one) for one in (rows, columns, lengths))
    graph = csr_matrix((np.tile(length, 2), (np.concatenate([a, b]), np.concatenate([b, a]))), (len(ys), len(ys)))
    return MedialAxis((np.stack([xs, ys], 1) - 1).astype(np.float64), inside[ys, xs].astype(np.float64), graph)


def _ends(axis: MedialAxis) -> _Ends:
    """The axis's ends, and the middles of what is round; of those close to one another, and of too many, those that stick out most."""
    distance = np.linalg.norm(axis.points[:, None] - axis.points, axis=-1)
    near = distance <= 2 * axis.radius[:, None]
    largest, least = np.where(near, axis.radius, 0).max(1), np.where(near, axis.radius, np.inf).min(1)
    wide = (axis.radius > TIPS_APART * axis.size) & (axis.radius > ROUND_WIDTH_RATIO * least)
    round_middles = np.flatnonzero((axis.radius >= largest) & wide)
    away = np.linalg.norm(axis.points - axis.points.mean(0), axis=1) + axis.radius
    kept: list[int] = []
    for one in (
        *sorted(round_middles.tolist(), key=lambda k: -float(axis.radius[k])),
        *sorted(np.flatnonzero(np.diff(axis.graph.indptr) == 1).tolist(), key=lambda k: -float(away[k])),
    ):
        if all(distance[one, other] > max(ROUND_RADII * axis.radius[other], TIPS_APART * axis.size) for other in kept):
            kept.append(one)
    kept = sorted(kept, key=lambda k: -float(away[k]))
    kept = kept[:MAX_ENDS]
    far, before = dijkstra(axis.graph, indices=kept, return_predecessors=True)
    ways: dict[tuple[int, int], NDArray[np.intp]] = {}
    for a in range(len(kept)):
        for b, place in enumerate(kept):
            way = [place]
            while before[a, way[-1]] >= 0:
                way.append(int(before[a, way[-1]]))
            ways[a, b] = np.array(way[::-1])
    return _Ends(axis.points[kept], far[:, kept], ways)


def _best_five(axis: MedialAxis, ends: _Ends) -> _Five | None:
    """Which ends are what; the person's left is at the picture's right."""
    best, found = MAX_SKELETON_COST, None
    numbers = range(len(ends.at))
    for feet in combinations(numbers, 2):
        for hands in combinations([k for k in numbers if k not in feet], 2):
            for head in (k for k in numbers if k not in feet and k not in hands):
                sides = [sorted(pair, key=lambda k: -ends.at[k, 0]) for pair in (hands, feet)]
                five = _parted(ends, head, (sides[0][0], sides[0][1]), (sides[1][0], sides[1][1]))
                if (cost := _cost(axis, ends, five)) < best:
                    best, found = cost, five
    return found


def _parted(ends: _Ends, head: int, hands: tuple[int, int], feet: tuple[int, int]) -> _Five:
    """Where the ways from the head part: half of what two of them are longer than the way between their ends."""
    apart = ends.apart
    leave = [float(np.mean([apart[head, hand] + apart[head, foot] - apart[hand, foot] for foot in feet])) / 2
             for hand in hands]  # fmt: skip
    crotch = float(apart[head, feet[0]] + apart[head, feet[1]] - apart[feet[0], feet[1]]) / 2
    return _Five(head, hands, feet, (leave[0], leave[1]), crotch)


def _cost(axis: MedialAxis, ends: _Ends, five: _Five) -> float:
    """How little five ends look like somebody's: 0 and more."""
    size = axis.size
    arms = [ends.apart[five.head, hand] - leave for hand, leave in zip(five.hands, five.arms_leave, strict=True)]
    legs = [ends.apart[five.head, foot] - five.crotch for foot in five.feet]
    used = (sum(arms) + sum(legs) + five.crotch) / axis.length
    unlike = abs(five.arms_leave[0] - five.arms_leave[1]) / size
    head, feet = ends.at[five.head], ends.at[list(five.feet)]
    shortest = min(*arms, *legs, *five.arms_leave, five.crotch)
    if (
        not np.isfinite(sum(arms + legs))
        or shortest < MIN_LIMB * size
        or _upright(head - feet.mean(0)) < MIN_UPRIGHT_COSINE
    ):
        return np.inf
    limbs = ((arms, five.hands, five.arms_leave), (legs, five.feet, (five.crotch, five.crotch)))
    for lengths, tips, leaves in limbs:
        for length, tip, leave in zip(lengths, tips, leaves, strict=True):
            way = ends.ways[five.head, tip]
            if length < STICKS_OUT * axis.radius[way[_place(axis, way, leave)]]:
                return np.inf
    ratios = [abs(np.log(pair[0] / pair[1])) for pair in (arms, legs)]
    if max(ratios) > np.log(MAX_LIMB_LENGTH_RATIO):
        return np.inf
    unlike += sum(ratios)
    high, low = axis.rows
    astray = (head[1] - high + low - feet[:, 1].mean()) / size
    return float(UNLIKE_COST * unlike + ASTRAY_COST * astray + LEFT_OVER_COST * (1 - used))


def _upright(way: NDArray[np.float64]) -> float:
    """The cosine of a way's (2,) angle with the picture's vertical, upwards."""
    return float(-way[1] / (np.linalg.norm(way) + 1e-9))


def _along(way: NDArray[np.float64], far: float) -> NDArray[np.float64]:
    """The point (2,) so far from the beginning of a way (n, 2)."""
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(way, axis=0), axis=1))])
    return np.array([np.interp(far, length, way[:, k]) for k in range(2)])


def _landmarks(axis: MedialAxis, ends: _Ends, five: _Five) -> dict[str, NDArray[np.float64]]:
    """All landmarks by their names. Joints lie on the ways along the axis; an arm or a leg begins where its way leaves the largest disk around
    the place at which it parts from the trunk."""
    way = ends.ways[five.head, five.feet[0]]
    leaves = min(five.arms_leave)
    neck = _along(axis.points[way], leaves)
    middle = _skull(axis, way, leaves)
    head, skull = axis.points[middle], float(axis.radius[middle])
    up = head - neck
    up = up / np.linalg.norm(up)
    left = np.array([-up[1], up[0]])
    marks = {"Nose": head}
    for side, towards, hand, foot, leaves in zip(
        SIDE_NAMES, (left, -left), five.hands, five.feet, five.arms_leave, strict=True
    ):
        arm = _from(axis, ends.ways[five.head, hand], leaves)
        leg = _from(axis, ends.ways[five.head, foot], five.crotch)
        marks |= _limb(arm, side, ("Shoulder", "Elbow", "Wrist"), (0.0, ELBOW_SHARE, WRIST_SHARE))
        marks |= _limb(leg, side, ("Hip", "Knee", "Ankle"), (0.0, KNEE_SHARE, ANKLE_SHARE))
        tip, toes = arm[-1], leg[-1]
        marks |= {f"{side}{finger}": tip for finger in ("Pinky", "Index", "Thumb")}
        marks |= {f"{side}Heel": marks[f"{side}Ankle"], f"{side}FootIndex": toes}
        eye = head + skull * EYE_OFFSET_RADII * (towards + 0.5 * up)
        marks |= {f"{side}{eye_part}": eye for eye_part in ("EyeInner", "Eye", "EyeOuter")}
        marks |= {
            f"{side}Ear": head + skull * EAR_OFFSET_RADII * towards,
            f"Mouth{side}": head + skull * MOUTH_OFFSET_RADII * (0.6 * towards - up),
        }
    return marks


def _skull(axis: MedialAxis, way: NDArray[np.intp], leaves: float) -> int:
    """The place on the way from the topmost end to where the arms leave, and outside of the trunk there, around which most has room: the
    head's middle, below its hair."""
    trunk = axis.radius[way[_place(axis, way, leaves)]]
    above = way[: _place(axis, way, max(leaves - trunk, 0.5 * leaves)) + 1]
    return int(above[np.argmax(axis.radius[above])])


def _place(axis: MedialAxis, way: NDArray[np.intp], far: float) -> int:
    """Which place of a way is so far from its beginning."""
    return int(np.searchsorted(axis.lengths(way), far).clip(0, len(way) - 1))


def _limb(
    way: NDArray[np.float64], side: str, joints: tuple[str, ...], shares: tuple[float, ...]
) -> dict[str, NDArray[np.float64]]:
    """The joints of a limb at shares of its way (n, 2)."""
    length = float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())
    return {f"{side}{joint}": _along(way, share * length) for joint, share in zip(joints, shares, strict=True)}


def _from(axis: MedialAxis, way: NDArray[np.intp], leaves: float) -> NDArray[np.float64]:
    """What of a way is the limb's own: points (n, 2)."""
    points = axis.points[way]
    begin = min(_place(axis, way, leaves), len(way) - 2)
    out = np.linalg.norm(points - points[begin], axis=1) >= axis.radius[way[begin]]
    out[:begin] = False
    first = int(np.argmax(out)) if out.any() else begin
    return points[min(first, len(way) - 2) :]
