"""The frame in which a captured person stands: metres, y up, the ground at zero, themselves at the origin, facing +z.

Up is where the cameras' rows say: a phone is held level, in the mean over a film. The ground is the floor around the person,
the height what silhouettes reach above it, and the front where body poses have it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.capture.person_lock import PersonLock, focus_of
from engine.avatar.capture.scene_cameras import ClipScene
from engine.geometry.multiview.bundle import Bundle, undistorted
from engine.geometry.registration.rigid import Similarity
from engine.perception.pose.body import Body

TAKEN_HEIGHT_METRES = 1.7
"""Metres that the person is taken to be tall: how tall they are is a matter of scale, which nothing that is measured tells."""
FLOOR_REACH_CAMERA_DISTANCES = 0.6
"""Distances of the cameras around the person within which the floor is looked for."""
FLOOR_THICKNESS_CAMERA_DISTANCES = 0.015
"""Distances of the cameras: a slab that holds the points of the floor."""
MIN_FLOOR_POINTS = 30
SAME_FRONT_RADIANS = np.radians(40)
"""Radians by which bodies may be seen turned from one another and agree on where the front is."""


@dataclass(frozen=True)
class PersonFrame:
    """A person's own frame.

    change : from a film's own frame to the person's.
    height : of the person in the film's own unit, by silhouettes.
    on_floor : whether the floor was found, or the person's lowest points had to do.
    """

    change: Similarity
    height: float
    on_floor: bool


def person_frame(
    scene: ClipScene,
    lock: PersonLock,
    masks: Sequence[NDArray[np.bool_]],
    bodies: Sequence[Body | None],
) -> PersonFrame:
    """The frame of the person in a film that shows them from head to foot.

    Parameters
    ----------
    scene : the cameras as the room has them; lock : as the person has them, in the same frame.
    masks, bodies : of each frame: (h, w) bool, and the body's pose if one was looked for and found.
    """
    bundle, solved = lock.scene.reconstruction.bundle, lock.scene.reconstruction.solved
    up = upward(bundle, scene.reconstruction.registered)
    distance = focus_of(scene.reconstruction).distance
    ours = bundle.points[solved]
    middle = np.median(ours, axis=0)
    floor = _floor(scene, lock.person, middle, up, distance)
    lowest = float(np.percentile(ours @ up, 1)) if floor is None else floor
    height = _top(scene, bundle, masks, middle, up) - lowest
    front = _front(bundle, scene.reconstruction.registered, bodies, up, middle)
    axes = np.stack([np.cross(up, front), up, front])
    origin = middle + (lowest - middle @ up) * up
    linear = TAKEN_HEIGHT_METRES / height * axes
    return PersonFrame(Similarity(linear, -linear @ origin), height, floor is not None)


def upward(bundle: Bundle, registered: NDArray[np.bool_]) -> NDArray[np.float64]:
    """(3,) the direction that all cameras' rows are square to, as well as can be: up, if they are level in the mean."""
    rows = bundle.rotations[registered, 0]
    up = np.linalg.eigh(rows.T @ rows)[1][:, 0]
    return np.asarray(-up if (bundle.rotations[registered, 1] @ up).sum() > 0 else up)


def _floor(
    scene: ClipScene, person: NDArray[np.bool_], middle: NDArray[np.float64], up: NDArray[np.float64], distance: float
) -> float | None:
    """How far up the floor lies: where most points below the person's middle and near them are. None where there are few."""
    found = scene.reconstruction
    points = found.bundle.points[found.solved & ~person]
    heights = points @ up
    aside = np.linalg.norm((points - middle) - np.outer((points - middle) @ up, up), axis=1)
    heights = np.sort(heights[(aside < FLOOR_REACH_CAMERA_DISTANCES * distance) & (heights < middle @ up)])
    if len(heights) < MIN_FLOOR_POINTS:
        return None
    ends = np.searchsorted(heights, heights + FLOOR_THICKNESS_CAMERA_DISTANCES * distance, side="right")
    counts = ends - np.arange(len(heights))
    best = int(np.argmax(counts))
    return float(np.median(heights[best : ends[best]])) if counts[best] >= MIN_FLOOR_POINTS else None


def _top(
    scene: ClipScene,
    bundle: Bundle,
    masks: Sequence[NDArray[np.bool_]],
    middle: NDArray[np.float64],
    up: NDArray[np.float64],
) -> float:
    """How far up silhouettes reach, over the person's middle: the median over the frames that show their upper end."""
    found = []
    for c in np.flatnonzero(scene.reconstruction.registered).tolist():
        rows = np.flatnonzero(masks[c].sum(axis=1) >= 2)
        if len(rows) < 2 or rows[0] < 2:
            continue
        columns = np.flatnonzero(masks[c][rows[0]])
        scale = scene.size[0] / masks[c].shape[0]
        pixel = (np.array([[columns.mean(), rows[0] - 0.5]]) + 0.5) * scale - 0.5
        lens = int(bundle.lens_of[c])
        ray = np.append(undistorted(pixel, bundle.lenses[lens], bundle.centres[lens])[0], 1.0) @ bundle.rotations[c]
        eye = bundle.eyes[c]
        level = ray - (ray @ up) * up
        reach = ((middle - eye) @ level) / (level @ level)
        found.append(float((eye + reach * ray) @ up))
    if not found:  # nobody's head is in the picture: the person's highest points
        solved = bundle.points[np.isfinite(bundle.points[:, 0])]
        return float(np.percentile(solved @ up, 99))
    return float(np.median(found))


def _front(
    bundle: Bundle,
    registered: NDArray[np.bool_],
    bodies: Sequence[Body | None],
    up: NDArray[np.float64],
    middle: NDArray[np.float64],
) -> NDArray[np.float64]:
    """(3,) level: what most of the bodies that were seen agree on; where none was, towards the film's first camera."""
    seen = []
    for c in np.flatnonzero(registered).tolist():
        body = bodies[c] if c < len(bodies) else None
        if body is None:
            continue
        across = sum(
            (body.joint(f"Left{joint}")[1] - body.joint(f"Right{joint}")[1] for joint in ("Arm", "UpLeg")), np.zeros(3)
        )
        left = (across * [1.0, -1.0, -1.0]) @ bundle.rotations[c]
        front = np.cross(left, up)
        if np.linalg.norm(front) > 0:
            seen.append(front / np.linalg.norm(front))
    if not seen:
        first = bundle.eyes[registered][0] - middle
        level = first - (first @ up) * up
        return np.asarray(level / np.linalg.norm(level))
    fronts = np.array(seen)
    agreeing = fronts @ fronts.T > np.cos(SAME_FRONT_RADIANS)
    mean = fronts[agreeing[int(agreeing.sum(axis=1).argmax())]].sum(axis=0)
    return np.asarray(mean / np.linalg.norm(mean))
