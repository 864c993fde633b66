"""A face's mesh without jitter, also where its head shakes.

What a tracker errs by from frame to frame is small beside what a lively head does, and a filter that takes the head's
motion for noise holds back all of it: lids, lips and the head itself. So jitter is measured on the head, where only
the face moves, in its quieter frames, and taken out there first. Then the head's own is taken out, which is hardly larger: one network sees both.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.rigid import fit_similarities
from engine.perception.face.landmarks import RIGID_VERTICES
from engine.perception.temporal_filter import BLOCK_POINTS, noise_level, remove_jitter

QUIET_QUANTILE = 0.25
"""Quantile of what a vertex does on the head from frame to frame that tells its jitter: talking lips rest for as long."""
FACE_JITTER_SHARE = 0.75
"""Of the jitter so found, what is taken out: with all of it blinks lose a twentieth of their depth, with 0.6 an open mouth is not still."""
MAX_HEAD_JITTER_SHARE = 3.0
"""Of the jitter of vertices on the head, up to which what the whole head does from frame to frame is jitter. Where it rests
it was 1 to 3 of them in five clips, and in one that shakes its head 9."""


@dataclass(frozen=True)
class HeadFrames:
    """Where a head is, in N frames: points of the video are scale * rotation @ (points of the first frame's head) + shift.

    scale : (N,).
    rotation : (N, D, D), D = 2 or 3.
    shift : (N, D) pixels.
    """

    scale: NDArray[np.float64]
    rotation: NDArray[np.float64]
    shift: NDArray[np.float64]

    @classmethod
    def of(cls, meshes: NDArray[np.floating]) -> HeadFrames:
        """Those of meshes (N, 478, D)."""
        rigid = meshes[:, list(RIGID_VERTICES)].astype(float)
        return cls(*fit_similarities(rigid[0], rigid, np.ones(len(RIGID_VERTICES))))

    def on_head(self, tracks: NDArray[np.floating]) -> NDArray[np.float32]:
        """Tracks (N, V, D) of the video as they move on the head."""
        return np.asarray((tracks - self.shift[:, None]) @ self.rotation / self.scale[:, None, None], np.float32)

    def in_video(self, tracks: NDArray[np.floating]) -> NDArray[np.float32]:
        """Tracks (N, V, D) on the head as they move in the video."""
        turned = self.scale[:, None, None] * (tracks @ self.rotation.transpose(0, 2, 1))
        return np.asarray(turned + self.shift[:, None], np.float32)

    def steadied(self, points: NDArray[np.floating], most: float) -> HeadFrames:
        """The head without its jitter, which is up to `most` pixels, by `points` (V, D) on it."""
        carried = self.in_video(np.broadcast_to(points, (len(self.scale), *points.shape)))
        smooth = remove_jitter(carried, np.minimum(noise_level(carried), most))
        return HeadFrames(*fit_similarities(points.astype(float), smooth.astype(float), np.ones(len(points))))


def steady_face(meshes: NDArray[np.float32], out: NDArray[np.float32] | None = None) -> NDArray[np.float32]:
    """Remove the jitter of a face and of its head.

    Parameters
    ----------
    meshes : (N, 478, 3) pixels, frame by frame.
    out : where the result goes; may be the `meshes` themselves.

    Returns
    -------
    (N, 478, 3): no frame looks later or earlier than it is.
    """
    head = HeadFrames.of(meshes)
    rigid = head.on_head(meshes[:, list(RIGID_VERTICES)])
    most = MAX_HEAD_JITTER_SHARE * float(np.median(noise_level(rigid)) * np.median(head.scale))
    if out is None:
        out = np.empty(meshes.shape, np.float32)
    _steady(meshes, np.arange(meshes.shape[1]), head, head.steadied(np.median(rigid, axis=0), most), out)
    return out


def steady_on_head(meshes: NDArray[np.float32], vertices: NDArray[np.integer]) -> None:
    """Remove, in place, the jitter that some `vertices` (V,) of faces (N, 478, 3), pixels, have on their heads; their depth stays."""
    head, depth = HeadFrames.of(meshes), meshes[:, vertices, 2]
    _steady(meshes, vertices, head, head, meshes)
    meshes[:, vertices, 2] = depth


def _steady(
    meshes: NDArray[np.float32],
    vertices: NDArray[np.integer],
    head: HeadFrames,
    steady: HeadFrames,
    out: NDArray[np.float32],
) -> None:
    """Put some `vertices` (V,) of meshes (N, 478, 3) whose head is at `head` to `out`, without jitter, where it is at `steady`."""
    for start in range(0, len(vertices), BLOCK_POINTS):  # a part at a time, so that a long clip takes little memory
        block = vertices[start : start + BLOCK_POINTS]
        acted = head.on_head(meshes[:, block])
        jitter = FACE_JITTER_SHARE * noise_level(acted, QUIET_QUANTILE)
        out[:, block] = steady.in_video(remove_jitter(acted, jitter, out=acted))


def steady_points(points: NDArray[np.float32], meshes: NDArray[np.float32]) -> NDArray[np.float32]:
    """Remove the jitter of points (N, K, 2) around a face that has `meshes` (N, 478, 3), pixels: what moves with the head is
    judged on it, and what stands still in the video."""
    carried = HeadFrames.of(meshes[..., :2]).on_head(points)
    return remove_jitter(points, np.minimum(noise_level(points), noise_level(carried)))
