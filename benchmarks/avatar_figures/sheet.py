"""An avatar to be looked at: eight sides, the head from near, and frames beside what the avatar shows there."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.avatar_figures.colours import pictures
from benchmarks.presentation.contact_sheet import Row, contact_sheet
from benchmarks.scan_studio.people.rigged_glb import TexturedPart
from benchmarks.scan_studio.scenery.drawing import draw_over, empty_depths, textured_mesh
from engine.geometry.camera import Camera

BACKGROUND_GREY_LEVEL = 110
"""Grey level around the avatar."""
FOCAL_PIXELS = 900.0
"""Pixels of the cameras of the sheet."""


def avatar_sheet(folder: Path, part: TexturedPart, cameras: Mapping[str, Mapping[int, Camera]]) -> NDArray[np.uint8]:
    """The sheet (H, W, 3) of the delivered avatar in the pose in which the person was filmed."""
    triangles = part.triangles.astype(np.int32)
    shade = np.ones(len(part.vertices), np.float32)
    mesh = textured_mesh(triangles, part.uv.astype(np.float32), triangles, shade, part.image)
    height, middle = float(part.vertices[:, 1].max()), part.vertices.mean(0)
    whole = Camera((0.0, 0.0, 1.0), FOCAL_PIXELS, (179.5, 329.5), (660, 360))
    near = Camera((0.0, 0.0, 1.0), FOCAL_PIXELS, (219.5, 219.5), (440, 440))

    def drawn(camera: Camera, rgb: NDArray[np.uint8] | None = None) -> NDArray[np.uint8]:
        picture = np.full((*camera.size, 3), BACKGROUND_GREY_LEVEL, np.uint8) if rgb is None else rgb.copy()
        draw_over(picture, empty_depths(camera), mesh, part.vertices, camera)
        return picture

    def seen(lens: Camera, distance: float, at: float, turn: float) -> NDArray[np.uint8]:
        eye = [middle[0] + distance * np.sin(turn), at, middle[2] + distance * np.cos(turn)]
        return drawn(lens.aimed(eye, [middle[0], at, middle[2]]))

    used = {clip: list(each)[:: max(1, len(each) // 4)][:4] for clip, each in cameras.items()}
    frames = list(pictures(folder, used))
    placed = [cameras[clip][frame] for clip, some in used.items() for frame in some]
    return contact_sheet(
        [
            Row([seen(whole, 2.7, height / 2, turn) for turn in np.arange(8) * np.pi / 4], "eight sides"),
            Row([seen(near, 0.65, height - 0.13, turn) for turn in (-0.8, 0.0, 0.8, 1.6, np.pi)], "head"),
            Row(frames, "frames"),
            Row([drawn(camera, frame) for camera, frame in zip(placed, frames, strict=True)], "the avatar over them"),
        ]
    )
