"""Lids no faster than people's.

A tracker that sees an eye half shut calls it open or shut: blinks close and open within a frame each. In a spontaneous blink
a lid falls within 0.1 seconds and rises within twice that (K.-A. Kwon and others, High-speed camera characterization
of voluntary eye blinking kinematics, 2013). So a lid begins to fall earlier, and has risen later; it is shut when it was
seen to be shut.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.lids_and_lips import LID_EDGE_VERTEX_PAIRS, LID_SKIN_VERTEX_PAIRS
from engine.face_animation.motion_transfer.usual_lids import SHUT_SHARE

FALLS_SECONDS, RISES_SECONDS = 0.1, 0.2
"""Seconds from open to shut, and back, at least."""


def slow_lids(meshes: NDArray[np.floating], neutral: int, fps: float) -> None:
    """Hold the lids of meshes (N, 478, 3) to these speeds, in place. Upper lids go down to where they have to be, and the
    skin above them goes half the way. The `neutral` frame stays as it is: all others are measured by it."""
    upper, lower = np.array(LID_EDGE_VERTEX_PAIRS).T
    gap = np.linalg.norm(meshes[:, upper, :2] - meshes[:, lower, :2], axis=-1)
    share = gap / np.maximum(gap[neutral], 1e-6)
    openness = np.stack(
        [share[:, eye + 2 : eye + 5].mean(axis=1) for eye in (0, len(LID_EDGE_VERTEX_PAIRS) // 2)], axis=1
    )
    held = held_openness(openness, neutral, fps)
    closed = np.repeat(1 - held / np.maximum(openness, 1e-6), len(LID_EDGE_VERTEX_PAIRS) // 2, axis=1)[..., None]
    way = (closed * (meshes[:, lower] - meshes[:, upper])).astype(meshes.dtype)
    meshes[:, [skin for skin, _ in LID_SKIN_VERTEX_PAIRS]] += 0.5 * way
    meshes[:, upper] += way


def held_openness(openness: NDArray[np.floating], neutral: int, fps: float) -> NDArray[np.float64]:
    """The largest (N, K) below the openness (N, K) of lids that does not change faster. Openness is 1 as usual and
    `SHUT_SHARE` shut. In a blink right beside the `neutral` frame lids are open as they were seen."""
    whole = np.asarray(openness, np.float64)
    frames = np.arange(len(whole))[:, None]
    falls, rises = ((1 - SHUT_SHARE) / (seconds * fps) for seconds in (FALLS_SECONDS, RISES_SECONDS))
    shut = np.maximum(np.minimum(whole, 1), SHUT_SHARE)  # wide eyes narrow, and shut ones settle, as they do
    before = np.minimum.accumulate((shut + falls * frames)[::-1])[::-1] - falls * frames
    after = np.minimum.accumulate(shut - rises * frames) + rises * frames
    beside = frames - neutral
    open_still = 1 - np.where(beside > 0, falls, rises) * np.abs(beside)
    held = np.maximum(np.minimum(before, after), np.minimum(shut, open_still))
    return np.where(held < shut - 1e-9, held * np.minimum(whole / shut, 1), whole)
