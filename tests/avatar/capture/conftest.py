"""A room with a pillar that sways, filmed once for all tests of cameras."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from made_room import Room, orbit
from numpy.typing import NDArray

from engine.avatar.capture.scene_cameras import ClipScene, solve_scene
from engine.geometry.camera import Camera


@dataclass(frozen=True)
class FilmedRoom:
    """`frames`, the true `cameras`, where the pillar stood in each (F, 2) metres, and the `scene` that was solved."""

    room: Room
    frames: list[NDArray[np.uint8]]
    cameras: list[Camera]
    sway: NDArray[np.float64]
    scene: ClipScene


@pytest.fixture(scope="session")
def filmed() -> FilmedRoom:
    """One orbit of twenty frames; the pillar goes 4 mm to and fro."""
    room, cameras = Room(), orbit(20)
    phase = 2 * np.pi * np.arange(20) / 20
    sway = 0.004 * np.stack([np.sin(1.5 * phase), np.cos(2.5 * phase)], axis=1)
    frames = [room.picture(one, (float(at[0]), float(at[1]))) for one, at in zip(cameras, sway, strict=True)]
    return FilmedRoom(room, frames, cameras, sway, solve_scene(frames))
