"""How unlike the films an avatar looks, beside the true shape and cameras through the same texture stage."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.avatar_figures.texture import textured_truth
from benchmarks.scan_studio.comparison.colour import film_colour_error
from benchmarks.scan_studio.people.rigged_glb import TexturedPart
from benchmarks.scan_studio.scenery.drawing import TexturedMesh, textured_mesh
from benchmarks.scan_studio.truth import Truth
from engine.geometry.camera import Camera
from engine.media.video import read_video

COMPARED_FRAME_STEP = 5
"""Each so many of the frames that were used are compared."""


def colour_errors(
    folder: Path, truth: Truth, part: TexturedPart, cameras: Mapping[str, Mapping[int, Camera]], size: int
) -> tuple[float, float]:
    """CIELAB root mean square errors over frames, each in its own exposure: of the avatar by its cameras, and of the truth by
    the true ones."""
    frames = {clip: list(each) for clip, each in cameras.items()}
    compared = {clip: used[::COMPARED_FRAME_STEP] for clip, used in frames.items()}
    oracle = textured_truth(folder, truth, frames, size)
    corners = oracle.surface.atlas.corners.astype(np.int32)
    true = _unshaded(oracle.surface.triangles, oracle.surface.atlas.uv, corners, oracle.texture)
    mine = _unshaded(
        part.triangles.astype(np.int32), part.uv.astype(np.float32), part.triangles.astype(np.int32), part.image
    )
    shown = [camera for clip, used in compared.items() for camera in (cameras[clip][frame] for frame in used)]
    known = [truth.person_camera(clip, frame) for clip, used in compared.items() for frame in used]
    return (
        _error(folder, compared, mine, part.vertices, shown),
        _error(folder, compared, true, oracle.surface.vertices, known),
    )


def pictures(folder: Path, frames: Mapping[str, Sequence[int]]) -> Iterator[NDArray[np.uint8]]:
    """Those frames of the films, clip by clip."""
    for clip, used in frames.items():
        wanted = set(used)
        for k, frame in enumerate(read_video(folder / f"{clip}.mp4")):
            if k in wanted:
                yield frame.rgb


def _error(
    folder: Path,
    frames: Mapping[str, Sequence[int]],
    mesh: TexturedMesh,
    vertices: NDArray[np.floating],
    cameras: Sequence[Camera],
) -> float:
    stands = [vertices] * len(cameras)
    return film_colour_error(mesh, stands, pictures(folder, frames), cameras, "fitted").rmse


def _unshaded(
    triangles: NDArray[np.int32], uv: NDArray[np.float32], corners: NDArray[np.int32], texture: NDArray[np.uint8]
) -> TexturedMesh:
    shade = np.ones(int(triangles.max()) + 1, np.float32)
    return textured_mesh(triangles, uv, corners, shade, texture)
