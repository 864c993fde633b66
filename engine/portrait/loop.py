"""A performance that repeats without a jump."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from engine.portrait.driver import DriverTrack

EASE_SECONDS = 0.6
"""The end eases into the beginning over this long, or half the clip if that is shorter."""


def close_loop(track: DriverTrack) -> DriverTrack:
    """The same track, its last frames led smoothly to where the first begins.

    The frame after the last is the first: the weight of the beginning would reach 1 just there.
    """
    count = len(track)
    frames = int(min(round(EASE_SECONDS * track.fps), count // 2))
    t = np.arange(1, frames + 1) / (frames + 1)
    weight = (t * t * (3 - 2 * t)).astype(np.float32)[:, None, None]
    meshes, periphery = track.meshes.copy(), track.periphery.copy()
    meshes[count - frames :] += weight * (meshes[0] - meshes[count - frames :])
    periphery[count - frames :] += weight * (periphery[0] - periphery[count - frames :])
    return replace(track, meshes=meshes, periphery=periphery)
