"""A motion: how the joints of a skeleton turn, and where its root is, over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Clip:
    """A motion for one `Skeleton`.

    rotations : (F, J, 4) float32, unit quaternions (x, y, z, w), each joint's rotation from the T-pose in its parent's
        axes.
    root : (F, 3) float32, the root joint's place, metres.
    fps : frames a second. A clip that loops does not repeat its first frame at the end: frame F would be frame 0 again
        (moved on by what the root travels).
    """

    name: str
    fps: float
    rotations: NDArray[np.float32]
    root: NDArray[np.float32]
    loops: bool = False

    @property
    def seconds(self) -> float:
        """How long it plays."""
        frames = len(self.rotations)
        return (frames if self.loops else frames - 1) / self.fps


def loop_step(clip: Clip) -> NDArray[np.float64]:
    """(3,) from the last frame of a loop to the frame that would follow, as far as the ground plane goes: the mean of
    the steps beside it; upwards, exactly back to the first frame's height."""
    root = np.asarray(clip.root, np.float64)
    if len(root) == 1:
        return np.zeros(3)
    step = (root[1] - root[0] + root[-1] - root[-2]) / 2
    step[1] = root[0, 1] - root[-1, 1]
    return np.asarray(step)
