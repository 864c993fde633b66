"""Arms that would go into trunk or legs are put outside: hands and forearms stop at this very body's surface.

A motion made for one body has its hands in the hips of a broader one, or in the thighs of who sits. Elbows are brought
out by turning the whole arm at the shoulder, wrists by bending it; hands keep how they are turned. What moves an arm is
spread over time, so that it is on its way before it touches. Where nothing touches nothing changes.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from engine.compiled import njit
from engine.motion import rotation
from engine.motion.arms.solid_body import SolidArm, SolidBody
from engine.motion.clip import Clip
from engine.motion.feet.inverse_kinematics import two_bones
from engine.motion.kinematics import place_joints, pose_transforms, world_rotations

Array = NDArray[np.float64]

AVOIDING_SECONDS = 0.2
"""Seconds before and after an arm would touch in which it is on its way out."""

ROUND_COUNT = 4
"""How often ways out are looked for, each time from where the arms have come to be once they are smooth."""

STEP_COUNT = 10
"""How often a frame's way out is looked for before it is made smooth."""

MAX_DEPTH_METRES = 0.12
"""Metres from the nearest surface beyond which nobody is inside: half of a trunk."""

SEEN_AHEAD_METRES = 0.04
"""Metres outside: who is further out does not come in while others go out."""

STIFFNESS = 0.01
"""How much staying counts beside each point's way out: where points push against each other an arm stays between them."""

SAME_POSE_QUATERNION = 1e-3
"""By which no part of a joint's quaternion differs where a clip ends as it begins."""

PALM_DIRECTION = (0.0, -1.0, 0.0)
"""Where palms face in T-pose."""

SIDEWAYS = 0.7
"""How much less a hand goes sideways than the way its palm or its back faces: it is laid on, and does not slip off."""


def arms_outside(body: SolidBody, clip: Clip) -> Clip:
    """The clip with hands and forearms outside trunk and legs; the same clip where none ever enters them. One that ends as it begins still does."""
    if not clip.loops and len(clip.rotations) > 2 and _ends_as_it_begins(clip):
        once = replace(clip, rotations=clip.rotations[:-1], root=clip.root[:-1], loops=True)
        outside = arms_outside(body, once)
        if outside is once:
            return clip
        return replace(clip, rotations=np.concatenate([outside.rotations, outside.rotations[:1]]))
    skeleton = body.skeleton
    transforms = pose_transforms(skeleton, clip.rotations, clip.root)
    surface = body.surface.posed(transforms)
    normals = body.above.posed(transforms) - surface
    world = world_rotations(skeleton.parents, clip.rotations)
    places = place_joints(skeleton.parents, skeleton.offsets(), world, clip.root)
    rotations = clip.rotations.copy()
    for arm in body.arms:
        moved = _TurnedArm(arm, world, places, transforms)
        if not _go_outside(moved, surface, normals, clip):
            continue
        rotations[moved.turned] = _with_arm(body, moved, rotations[moved.turned])
    return clip if np.array_equal(rotations, clip.rotations) else replace(clip, rotations=rotations)


def _ends_as_it_begins(clip: Clip) -> bool:
    first, last = clip.rotations[0], clip.rotations[-1]
    apart = np.minimum(np.abs(last - first).max(-1), np.abs(last + first).max(-1))
    return bool(apart.max() < SAME_POSE_QUATERNION)


class _TurnedArm:
    """An arm over time, as it is turned: `upper` and `lower` (F, 4), its bones in the world, and where its `points` (F, P, 3) are.
    `turned` (N,) are the frames in which it is not as in the clip.

    `elbow_goes` and `wrist_goes` (F, 3, 3), symmetric, say how far they go each way when joints turn alike: not along a bone, and the
    wrist along a straight arm as little as the squared sine of the elbow's bend.
    """

    def __init__(self, arm: SolidArm, world: Array, places: Array, transforms: NDArray[np.float32]) -> None:
        self.arm, self.world = arm, world
        self._own, self._transforms = places[:, arm.joints], transforms
        self.upper, self.lower = world[:, arm.joints[0]].copy(), world[:, arm.joints[1]].copy()
        self.points = arm.points.posed(transforms)
        first, second = (rotation.normalize(bone) for bone in np.diff(self._own, axis=1).swapaxes(0, 1))
        straight = np.sum(first * second, 1)[:, None, None]
        self.elbow_goes = _across(first)
        across = _across(rotation.normalize(self._own[:, 2] - self._own[:, 0]))
        by_joints = straight**2 * across + (1 - straight**2) * np.eye(3)
        by_palm = np.eye(3) - SIDEWAYS * _across(rotation.rotate(world[:, arm.joints[2]], PALM_DIRECTION))
        self.wrist_goes = by_joints @ by_palm @ by_joints
        self.turned = np.zeros(0, np.intp)

    def turn(self, elbow: Array, wrist: Array) -> None:
        """Turn the arm so that its elbow goes by `elbow` (F, 3) from where it was, and its wrist, which goes along, on by
        `wrist` (F, 3), metres. The hand keeps its turn in the world."""
        which = np.flatnonzero(elbow.any(1) | wrist.any(1))
        self.turned = which
        begin, middle, end = self._own[which].swapaxes(0, 1)
        joints = self.arm.joints
        turn = rotation.between(middle - begin, middle + elbow[which] - begin)
        middle, end = begin + rotation.rotate(turn, middle - begin), begin + rotation.rotate(turn, end - begin)
        upper, lower = (rotation.multiply(turn, self.world[which, joint]) for joint in joints[:2])
        reach = np.linalg.norm(end - begin, axis=1, keepdims=True)
        stretched = reach + np.sum(wrist[which] * (end - begin), 1, keepdims=True) / reach
        target = begin + stretched * rotation.normalize(end + wrist[which] - begin)
        bent = two_bones((begin, middle, end), (upper, lower), target, self.arm.hinge)
        reaches = wrist[which].any(1, keepdims=True)
        self.upper[which], self.lower[which] = np.where(reaches, bent[0], upper), np.where(reaches, bent[1], lower)
        lengths = rotation.rotate(rotation.inverse(self.world[which][:, joints[:2]]), np.diff(self._own[which], axis=1))
        middle = begin + rotation.rotate(self.upper[which], lengths[:, 0])
        end = middle + rotation.rotate(self.lower[which], lengths[:, 1])
        transforms = self._transforms[which]
        for joint, head, turns, place in zip(
            joints, self.arm.heads, (self.upper, self.lower), (begin, middle), strict=False
        ):
            matrices = rotation.to_matrix(turns[which])
            transforms[:, joint, :3, :3] = matrices
            transforms[:, joint, :3, 3] = place - matrices @ head
        transforms[..., :3, 3][:, self.arm.hand] += (end - self._own[which, 2])[:, None]
        self.points[which] = self.arm.points.posed(transforms)


def _go_outside(arm: _TurnedArm, surface: NDArray[np.float32], normals: NDArray[np.float32], clip: Clip) -> bool:
    """Turn the arm out of the surface, its elbow first, which takes the wrist along; False where it is outside already."""
    along = arm.arm.along
    near = along < 0.5
    elbow, wrist = np.zeros((len(surface), 3)), np.zeros((len(surface), 3))
    for moved, which, shares, goes in (
        (elbow, near, 1 + along[near], arm.elbow_goes),  # about the shoulder: further off it further
        (wrist, ~near, along[~near], arm.wrist_goes),
    ):
        asked = np.arange(len(surface))
        for _ in range(ROUND_COUNT):
            ways = np.zeros_like(moved)
            ways[asked] = _ways_out(arm.points[asked][:, which], shares, goes[asked], surface[asked], normals[asked])
            if not ways.any():
                break
            moved += _smooth(ways, clip)
            arm.turn(elbow, wrist)
            asked = np.flatnonzero(moved.any(1))
    return len(arm.turned) > 0


def _with_arm(body: SolidBody, arm: _TurnedArm, rotations: NDArray[np.float32]) -> NDArray[np.float32]:
    """The local `rotations` (N, J, 4) of the frames in which the arm is turned, with the arm so."""
    frames = arm.turned
    upper, _, hand = arm.arm.joints
    parent = arm.world[frames, body.skeleton.parents[upper]]
    chain = [parent, arm.upper[frames], arm.lower[frames], arm.world[frames, hand]]
    turned = rotations.copy()
    for joint, above, own in zip(arm.arm.joints, chain[:-1], chain[1:], strict=True):
        local = rotation.multiply(rotation.inverse(above), own)
        other_side = np.sum(local * rotations[:, joint], -1, keepdims=True) < 0
        turned[:, joint] = rotation.normalize(np.where(other_side, -local, local))
    return turned


def _smooth(ways: Array, clip: Clip) -> Array:
    """(F, 3) ways that begin before they are needed and end after it: each frame's the longest of those around it, smoothed."""
    window = max(round(AVOIDING_SECONDS * clip.fps), 1)
    frames = np.arange(len(ways))
    around = frames[:, None] + np.arange(-window, window + 1)
    around = around % len(ways) if clip.loops else np.clip(around, 0, len(ways) - 1)
    longest = np.argmax(np.linalg.norm(ways, axis=1)[around], axis=1)
    widened = ways[around[frames, longest]]
    return np.asarray(
        gaussian_filter1d(widened, window / 2, axis=0, mode="wrap" if clip.loops else "nearest", truncate=2.0)
    )


def _across(directions: Array) -> Array:
    """(F, 3, 3) what leaves of a way only what is across these unit directions (F, 3)."""
    return np.asarray(np.eye(3) - directions[:, :, None] * directions[:, None])


def _ways_out(
    points: NDArray[np.float32],
    shares: Array,
    goes: Array,
    surface: NDArray[np.float32],
    normals: NDArray[np.float32],
) -> Array:
    """(F, 3) the way, metres, that brings `points` (F, P, 3), which go along with `shares` (P,) of it, out of the `surface`
    (F, S, 3), whose `normals` (F, S, 3) have any length. `goes` (F, 3, 3): how far each way it is easy to go."""
    ways = np.zeros((len(points), 3))
    _find_ways(np.ascontiguousarray(points), shares, goes, surface, normals, ways)
    return ways


@njit(nogil=True, boundscheck=False, error_model="numpy")
def _find_ways(points, shares, goes, surface, normals, ways):  # type: ignore[no-untyped-def]
    """Gauss-Newton on the depths of the points that are inside, by the planes of the surface's points that are nearest to them.
    Points that are far out at first are left out after that."""
    near, asked = np.empty(surface.shape[1], np.int64), np.empty(points.shape[1], np.int64)
    row = np.empty(3)
    for f in range(len(points)):
        count = _gather_near(points[f], surface[f], near)
        asked_count = points.shape[1] if count > 0 else 0
        for p in range(asked_count):
            asked[p] = p
        for _ in range(STEP_COUNT):
            matrix, pull = np.zeros((3, 3)), np.zeros(3)
            kept = 0
            for i in range(asked_count):
                p = asked[i]
                depth, nx, ny, nz = _depth(points[f, p], shares[p], ways[f], surface[f], normals[f], near, count)
                if depth < -SEEN_AHEAD_METRES:
                    continue
                asked[kept] = p
                kept += 1
                if depth <= 0:
                    continue
                for a in range(3):
                    matrix[a, a] += STIFFNESS
                for a in range(3):
                    row[a] = shares[p] * (goes[f, a, 0] * nx + goes[f, a, 1] * ny + goes[f, a, 2] * nz)
                for a in range(3):
                    pull[a] += row[a] * depth
                    for b in range(3):
                        matrix[a, b] += row[a] * row[b]
            asked_count = kept
            if pull[0] == 0 and pull[1] == 0 and pull[2] == 0:
                break
            _solve(matrix, pull, row)
            for a in range(3):
                ways[f, a] += goes[f, a, 0] * row[0] + goes[f, a, 1] * row[1] + goes[f, a, 2] * row[2]


@njit(nogil=True, boundscheck=False, error_model="numpy")
def _depth(point, share, way, surface, normals, near, count):  # type: ignore[no-untyped-def]
    """How deep a point is that has gone its share of the way, metres, and the normal there."""
    x, y, z = point[0] + share * way[0], point[1] + share * way[1], point[2] + share * way[2]
    best, nearest = MAX_DEPTH_METRES**2, -1
    for k in range(count):
        s = near[k]
        dx, dy, dz = surface[s, 0] - x, surface[s, 1] - y, surface[s, 2] - z
        squared = dx * dx + dy * dy + dz * dz
        if squared < best:
            best, nearest = squared, s
    if nearest < 0:
        return -np.inf, 0.0, 0.0, 0.0
    nx, ny, nz = normals[nearest, 0], normals[nearest, 1], normals[nearest, 2]
    length = max(np.sqrt(nx * nx + ny * ny + nz * nz), 1e-12)
    nx, ny, nz = nx / length, ny / length, nz / length
    dx, dy, dz = surface[nearest, 0] - x, surface[nearest, 1] - y, surface[nearest, 2] - z
    return dx * nx + dy * ny + dz * nz, nx, ny, nz


@njit(nogil=True, boundscheck=False, error_model="numpy")
def _gather_near(points, surface, near):  # type: ignore[no-untyped-def]
    """How many points of the surface may be near enough to be the nearest of any; `near` gets which."""
    middle = np.zeros(3)
    for p in range(len(points)):
        for a in range(3):
            middle[a] += points[p, a] / len(points)
    reach = 0.0
    for p in range(len(points)):
        squared = 0.0
        for a in range(3):
            squared += (points[p, a] - middle[a]) ** 2
        reach = max(reach, squared)
    limit = (np.sqrt(reach) + MAX_DEPTH_METRES) ** 2
    count = 0
    for s in range(len(surface)):
        squared = 0.0
        for a in range(3):
            squared += (surface[s, a] - middle[a]) ** 2
        if squared < limit:
            near[count] = s
            count += 1
    return count


@njit(nogil=True, boundscheck=False, error_model="numpy")
def _solve(matrix, right, solution):  # type: ignore[no-untyped-def]
    """Write into `solution` what solves a symmetric system of three, by Cramer's rule."""
    a, b, c = matrix[0, 0], matrix[0, 1], matrix[0, 2]
    d, e, g = matrix[1, 1], matrix[1, 2], matrix[2, 2]
    aa, bb, cc = d * g - e * e, c * e - b * g, b * e - c * d
    determinant = a * aa + b * bb + c * cc
    dd, ee, gg = a * g - c * c, b * c - a * e, a * d - b * b
    solution[0] = (aa * right[0] + bb * right[1] + cc * right[2]) / determinant
    solution[1] = (bb * right[0] + dd * right[1] + ee * right[2]) / determinant
    solution[2] = (cc * right[0] + ee * right[1] + gg * right[2]) / determinant
