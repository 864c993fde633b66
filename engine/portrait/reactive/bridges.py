"""Ways out of a clip: from nearly any of its frames a few rendered ones that lead to rest.

A clip that is broken off cannot jump to another's first frame, and cross-fading would show two faces. So poses of the
clip are chosen as exits, close enough together that every frame has one that can hardly be told from it, and from each
exit a short bridge is rendered. A player shows the bridge of the exit that belongs to the frame it is at.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.portrait.reactive.excursion import Pose

EXIT_TOLERANCE = 0.4
"""How far an exit may be from the frames that use it, against the longest step between two frames of its clip."""
MIN_PACE_SHARE = 0.5
"""Share of the longest step in all clips that a clip's own longest step counts for at least there."""
UNSEEN_PIXELS = (0.25, 0.8)
"""Pixels by which an exit may be off in any case, of the head and of the furthest point: nobody sees less."""
BRIDGE_TAPER_SHARE = 0.5
"""Share of a bridge in which it speeds up and slows down; in the middle it goes evenly."""
MAX_BRIDGE_STEP = 0.5
"""The longest step of a bridge against the longest in all clips: a head that goes back to rest does not snap back."""
MIN_BRIDGE_FRAMES = 3
"""Frames of the shortest bridge."""
MAX_BRIDGE_FRAMES = 12
"""Frames of the longest bridge."""
HOLD_FRAMES = 2
"""Frames of rest after each bridge, which cost next to nothing: a player that stops late shows nothing else."""
MAX_FRAMES_PER_KEYFRAME = 32
"""Bridges are coded one after another from one whole picture on, the one at rest, as long as no more frames than these
follow it. That many must be decoded at worst before a bridge is seen, and whole pictures are what bridges cost."""


@dataclass(frozen=True)
class PoseDistance:
    """How far two poses are apart, in pixels: by half of the control points (the head), and by the furthest (a lid)."""

    head: float
    furthest: float

    @classmethod
    def between(cls, one: NDArray[np.float32], other: NDArray[np.float32] | float = 0.0) -> PoseDistance:
        far = np.linalg.norm(one - other, axis=1)
        return cls(float(np.median(far)), float(far.max()))

    def against(self, other: PoseDistance) -> float:
        """The larger of the two ratios."""
        return max(self.head / max(other.head, 1e-3), self.furthest / max(other.furthest, 1e-3))


@dataclass(frozen=True)
class BridgeSegment:
    """A bridge in its file: the `start` of its frames, and how many (`length`) lead to rest. `HOLD_FRAMES` frames at rest
    follow; where it is the first after a whole picture, that one comes before it (`opens`)."""

    start: int
    length: int
    opens: bool


@dataclass(frozen=True)
class ExitBridges:
    """Ways out of one clip.

    frames : those of the clip with whose poses bridges begin.
    lengths : of the bridges, frames.
    at : for each frame of the clip the exit; -1 where it is at rest, or as good as.
    """

    frames: tuple[int, ...]
    lengths: tuple[int, ...]
    at: tuple[int, ...]

    def segments(self) -> list[BridgeSegment]:
        """Where the bridges lie in their file."""
        placed: list[BridgeSegment] = []
        end, room = 0, 0
        for length in self.lengths:
            opens = room < length + HOLD_FRAMES
            if opens:
                end, room = end + 1, MAX_FRAMES_PER_KEYFRAME
            placed.append(BridgeSegment(end, length, opens))
            end, room = end + length + HOLD_FRAMES, room - length - HOLD_FRAMES
        return placed


def longest_step(poses: Sequence[Pose], loops: bool) -> PoseDistance:
    """The longest steps from frame to frame of a clip."""
    offsets = [pose.motion.offsets for pose in poses]
    ahead = offsets[1:] + (offsets[:1] if loops else [])
    steps = [PoseDistance.between(one, other) for one, other in zip(offsets, ahead, strict=False)]
    return PoseDistance(max(step.head for step in steps), max(step.furthest for step in steps))


def find_exits(poses: Sequence[Pose], step: PoseDistance, pace: PoseDistance) -> ExitBridges:
    """Exits for a clip, as few as serve all of its frames.

    Parameters
    ----------
    step : the longest of the clip itself; pace : the longest of all clips of the profile.
    """
    step = PoseDistance(
        max(step.head, MIN_PACE_SHARE * pace.head, UNSEEN_PIXELS[0] / EXIT_TOLERANCE),
        max(step.furthest, MIN_PACE_SHARE * pace.furthest, UNSEEN_PIXELS[1] / EXIT_TOLERANCE),
    )
    offsets = [pose.motion.offsets for pose in poses]
    resting = [PoseDistance.between(one).against(step) <= EXIT_TOLERANCE for one in offsets]
    frames: list[int] = []
    at: list[int] = []
    while len(at) < len(poses):
        first = len(at)
        if resting[first]:
            at.append(-1)
            continue
        chosen = _furthest(offsets, resting, first, first, step)
        frames.append(chosen)
        last = _furthest(offsets, resting, chosen, chosen, step)
        at += [len(frames) - 1] * (last - first + 1)
    far = [PoseDistance.between(offsets[frame]).against(pace) for frame in frames]
    steps = [one / (MAX_BRIDGE_STEP * (1 - BRIDGE_TAPER_SHARE / 2)) for one in far]
    lengths = tuple(int(np.clip(np.ceil(one) - 1, MIN_BRIDGE_FRAMES, MAX_BRIDGE_FRAMES)) for one in steps)
    return ExitBridges(tuple(frames), lengths, tuple(at))


def _furthest(
    offsets: Sequence[NDArray[np.float32]], resting: Sequence[bool], start: int, of: int, step: PoseDistance
) -> int:
    """The last frame from `start` on up to which all are near the pose of the frame `of`."""
    last = start
    while (
        last + 1 < len(offsets)
        and not resting[last + 1]
        and PoseDistance.between(offsets[last + 1], offsets[of]).against(step) <= EXIT_TOLERANCE
    ):
        last += 1
    return last


def bridge(pose: Pose, segment: BridgeSegment, rest: NDArray[np.float32]) -> Iterator[Pose]:
    """The frames of a bridge's segment: the poses between this one and rest, with what comes before and after."""
    if segment.opens:
        yield pose.eased(0.0, rest)
    for weight in 1 - ease_in_out(np.arange(1, segment.length + 1) / (segment.length + 1)):
        yield pose.eased(float(weight), rest)
    for _ in range(HOLD_FRAMES):
        yield pose.eased(0.0, rest)


def ease_in_out(t: NDArray[np.floating]) -> NDArray[np.float64]:
    """From 0 at 0 to 1 at 1, at rest at both and with an even pace between, so that no step is much longer than the mean
    (the integral of a cosine-tapered window)."""
    late = t > 0.5
    u = np.where(late, 1 - t, t)
    begins = 0.5 * (u - BRIDGE_TAPER_SHARE / (2 * np.pi) * np.sin(2 * np.pi * u / BRIDGE_TAPER_SHARE))
    way = np.where(u < BRIDGE_TAPER_SHARE / 2, begins, u - BRIDGE_TAPER_SHARE / 4) / (1 - BRIDGE_TAPER_SHARE / 2)
    return np.asarray(np.where(late, 1 - way, way), float)
