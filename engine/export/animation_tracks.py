"""Clips as the keyframes that file formats and players want: continuous, closed where they loop, without the still
joints."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.clip import Clip, loop_step
from engine.motion.half_turns import with_half_turns

STILL_TOLERANCE = 1e-5
"""Radians, or metres: what moves less than this stands still."""

SINGLE_FRAME_SECONDS = 1.0
"""Seconds for which a clip of one frame is held: players stumble over animations that take no time."""


@dataclass(frozen=True)
class Tracks:
    """K keyframes of one clip of a skeleton with J joints.

    times : (K,) float32 seconds from 0.
    rotations : (K, J, 4) float32 unit quaternions (x, y, z, w), neighbours in the same half of the sphere.
    root : (K, 3) float32 metres.
    turning : (J,) bool, the joints that ever leave the T-pose.
    moving : (J,) bool, those that also change over time.
    """

    times: NDArray[np.float32]
    rotations: NDArray[np.float32]
    root: NDArray[np.float32]
    turning: NDArray[np.bool_]
    moving: NDArray[np.bool_]


def tracks(clip: Clip, skeleton: Skeleton) -> Tracks:
    """Keyframes for `clip`: one for each frame; one more that closes a loop; two for a clip of a single frame.

    Raises ValueError where the clip was made for another skeleton or holds no frame.
    """
    frames = len(clip.rotations)
    if frames == 0 or clip.rotations.shape[1:] != (len(skeleton.names), 4) or clip.root.shape != (frames, 3):
        raise ValueError(f"the clip {clip.name!r} does not fit a skeleton of {len(skeleton.names)} joints")
    rotations, root = with_half_turns(skeleton, clip.rotations), clip.root.astype(np.float64)
    if frames == 1:
        rotations, root = rotations.repeat(2, 0), root.repeat(2, 0)
        times = np.array([0, SINGLE_FRAME_SECONDS])
    else:
        if clip.loops:
            rotations = np.concatenate([rotations, rotations[:1]])
            root = np.concatenate([root, closing_root(clip)[None]])
        times = np.arange(len(rotations)) / clip.fps
    rotations = rotation.same_signs(rotation.normalize(rotations))
    return Tracks(
        times=times.astype(np.float32),
        rotations=rotations.astype(np.float32),
        root=root.astype(np.float32),
        turning=rotation.angle(rotations).max(0) > STILL_TOLERANCE,
        moving=rotation.angle(rotation.multiply(rotation.inverse(rotations[0]), rotations)).max(0) > STILL_TOLERANCE,
    )


def closing_root(clip: Clip) -> NDArray[np.float64]:
    """Where the root is one frame after the last of a loop, (3,): at its first place again, moved on by what it
    travels over the ground.

    Along each axis of the ground, a loop travels if its ends lie further apart than three of its longest steps:
    one that closes comes back within about one.
    """
    root = np.asarray(clip.root, np.float64)
    travels = np.abs(root[-1] - root[0]) > 3 * np.abs(np.diff(root, axis=0)).max(0)
    return np.where(travels, root[-1] + loop_step(clip), root[0])
