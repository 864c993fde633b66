"""A performance as a film: moments in which much changes are lit in full, those between them carry their light.

Lighting a scene takes ten times as long as finding what the camera sees of it. Between two key frames a face moves by
little, and every point of its surface keeps nearly the light that it had. So each point that the camera sees in between is
looked up in both key frames, where its own surface shows it, and blended by time. The shape, the rims and the hair are
those of the very moment; a frame that shows too much of what neither key frame saw becomes one.

The idea is that of B. Walter et al., Interactive Rendering using the Render Cache, 1999: surface points are
reprojected, not pixels.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numba import prange
from numpy.typing import NDArray

from engine.compiled import njit
from engine.performances.modelling.actor import Actor, Scene, stage
from engine.performances.modelling.figure import Pose
from engine.performances.rendering.studio import (
    SAMPLES_PER_PIXEL_SIDE,
    STUDIO_CAMERA,
    Exposure,
    backdrop,
    expose,
    finish,
    parts_seen,
)
from engine.render.rasterisation.attributes import interpolate
from engine.render.rasterisation.rasteriser import rasterise

MAX_KEY_FRAME_DISTANCE = 14
"""Frames between two key frames at most."""

MAX_POSE_CHANGES = {"unit": 0.75, "blink": 1.0, "head": 9.0, "gaze": 7.0, "breath": 1.0}
"""How far a pose may go between two key frames: weights of face units, of blinks, degrees of head and gaze."""

MAX_UNSEEN_PIXELS = 300
"""Supersampled pixels that neither key frame saw, beyond which a frame is lit in full: one in three thousand."""

MIN_COVERAGE = 0.02
"""What is seen by less than this share of a pixel counts as not seen."""

SAME_SURFACE_METRES = 0.0025
"""Metres along the view by which two points of one surface may differ within a pixel."""


def film(
    actor: Actor, poses: Sequence[Pose], samples: int = SAMPLES_PER_PIXEL_SIDE, detail: float = 1.0
) -> Iterator[NDArray]:
    """The pictures (SIZE, SIZE, 3) uint8 of the `poses`, in order."""

    def lit(index: int) -> Exposure:
        return expose(actor, stage(actor, poses[index]), samples, detail)

    keys = key_frames(poses)
    first = lit(keys[0])
    for start, end in zip(keys, [*keys[1:], keys[-1]], strict=True):
        yield finish(first, actor, samples)
        last = lit(end) if end > start else first
        for index in range(start + 1, end):
            share = (index - start) / (end - start)
            between = carry(first, last, share, stage(actor, poses[index], lit=False), samples)
            if between is None:
                between = first = lit(index)  # what follows is carried from here
                start = index
            yield finish(between, actor, samples)
        first = last


def key_frames(poses: Sequence[Pose]) -> list[int]:
    """The frames that are lit in full: the first, the last, and where the way since the last one has grown long."""
    keys, way = [0], 0.0
    for index in range(1, len(poses)):
        step = _step(poses[index - 1], poses[index])
        if index - keys[-1] > 0 and (way + step > 1 or index - keys[-1] >= MAX_KEY_FRAME_DISTANCE):
            keys.append(index - 1 if way > 0 and index - 1 > keys[-1] else index)
            way = 0.0 if keys[-1] == index else step
        else:
            way += step
    return keys if keys[-1] == len(poses) - 1 else [*keys, len(poses) - 1]


def carry(
    first: Exposure, last: Exposure, share: float, scene: Scene, samples: int = SAMPLES_PER_PIXEL_SIDE
) -> Exposure | None:
    """A scene in the light of two others: that of `first` and, by `share` [0, 1], of `last`.

    None where more than `MAX_UNSEEN_PIXELS` pixels were seen in neither.
    """
    camera = STUDIO_CAMERA.scaled(samples)
    raster = rasterise(camera.project(scene.vertices), scene.triangles, camera.size, perspective=True)
    parts = parts_seen(scene, raster)
    light, weight = np.zeros((*camera.size, 3), np.float32), np.zeros(camera.size, np.float32)
    for key, factor in ((first, 1 - share), (last, share)):
        pixels = camera.project(interpolate(key.scene.vertices, scene.triangles, raster))
        _look_up(key, _ScenePoints(parts, pixels), factor, light, weight)
    covered, known = parts >= 0, weight > MIN_COVERAGE
    if int((covered & ~known).sum()) > MAX_UNSEEN_PIXELS * (samples / SAMPLES_PER_PIXEL_SIDE) ** 2:
        return None
    radiance = backdrop(camera.size)
    radiance[known] = light[known] / weight[known, None]
    _fill(radiance, parts, known)
    hair = tuple(np.float32(1 - share) * a + np.float32(share) * b for a, b in zip(first.hair, last.hair, strict=True))
    return Exposure(scene, raster, parts, radiance, hair)


def _look_up(
    key: Exposure, points: _ScenePoints, factor: float, light: NDArray[np.float32], weight: NDArray[np.float32]
) -> None:
    """Add to `light` (H, W, 3) and `weight` (H, W) what a key frame shows of each visible point, times `factor`."""
    shown = _KeyFrame(key.radiance, key.raster.depth, key.parts)
    _gather(points, shown, np.array([factor, SAME_SURFACE_METRES], np.float32), light, weight)


class _ScenePoints(NamedTuple):
    """The visible point of each pixel: its part (H, W), -1 where nothing is, and where a key frame's camera sees it, (H, W, 3)
    as `Camera.project` gives it."""

    parts: np.ndarray
    pixels: np.ndarray


class _KeyFrame(NamedTuple):
    """A key frame: each pixel's radiance, depth and part."""

    radiance: np.ndarray
    depth: np.ndarray
    parts: np.ndarray


@njit(parallel=True, error_model="numpy")
def _gather(points: _ScenePoints, key: _KeyFrame, terms: np.ndarray, light: np.ndarray, weight: np.ndarray) -> None:
    own, pixels = points
    radiance, depth, parts = key
    height, width = own.shape
    factor, tolerance = terms
    one = np.float32(1)
    for y in prange(height):
        for x in range(width):
            if own[y, x] < 0:
                continue
            u, w, distance = pixels[y, x, 0], pixels[y, x, 1], pixels[y, x, 2]
            left, top = int(np.floor(u)), int(np.floor(w))
            if left < 0 or top < 0 or left + 1 >= width or top + 1 >= height:
                continue
            for j in range(2):
                for i in range(2):
                    row, column = top + j, left + i
                    if parts[row, column] != own[y, x] or abs(depth[row, column] - distance) > tolerance:
                        continue
                    near = factor * (one - abs(u - np.float32(column))) * (one - abs(w - np.float32(row)))
                    weight[y, x] += near
                    for c in range(3):
                        light[y, x, c] += near * radiance[row, column, c]


def _fill(radiance: NDArray[np.float32], parts: NDArray[np.int8], known: NDArray[np.bool_]) -> None:
    """Give the few points that no key frame saw the light of their nearest neighbours of the same part, in place."""
    height, width = known.shape
    for y, x in np.argwhere((parts >= 0) & ~known):
        for reach in (2, 5, 12, 30):
            rows = slice(max(y - reach, 0), min(y + reach + 1, height))
            columns = slice(max(x - reach, 0), min(x + reach + 1, width))
            alike = known[rows, columns] & (parts[rows, columns] == parts[y, x])
            if alike.any():
                radiance[y, x] = radiance[rows, columns][alike].mean(0)
                break


def _step(before: Pose, after: Pose) -> float:
    """How far one pose is from the next, in shares of what may lie between two key frames."""
    names = set(before.units) | set(after.units)
    moved = [
        abs(before.units.get(name, 0.0) - after.units.get(name, 0.0))
        / MAX_POSE_CHANGES["blink" if name.startswith("eyeBlink") else "unit"]
        for name in names
    ]
    for kind, one, other in (
        ("head", before.head, after.head),
        ("gaze", before.gaze, after.gaze),
        ("breath", (before.breath,), (after.breath,)),
    ):
        moved += [abs(a - b) / MAX_POSE_CHANGES[kind] for a, b in zip(one, other, strict=True)]
    return max(moved, default=0.0)
