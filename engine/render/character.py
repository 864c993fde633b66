"""Draws a character in a pose over a background: textured, with smooth edges and a soft shadow on the ground.

Nothing here starts threads of its own, and all inner loops let others run: frames are drawn side by side, one thread
each (`film_cast`).
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from numba import njit
from numpy.typing import NDArray

from engine.body.skinning import pose_transforms, skin
from engine.geometry.skinned_mesh import SkinnedMesh
from engine.geometry.welding import is_closed, weld
from engine.motion.clip import Clip
from engine.render.camera import Camera
from engine.render.ground_shadow import GroundShadow, cast_on_ground
from engine.render.mipmap import Mipmap, build_mipmap, look_up
from engine.render.rasteriser import draw_into
from engine.render.surface import vertex_normals

SAMPLES = 3
"""Samples to a pixel, along each axis: ten steps from outside to inside along an edge."""

LIGHT = (0.35, 0.75, 0.55)
"""Direction towards the light of the optional shading, in the world."""

AHEAD = 2
"""Frames drawn or waiting for each thread."""


@dataclass(frozen=True)
class Drawn:
    """`rgb` (H, W, 3) uint8; `alpha` (H, W) float32 [0, 1]: how much of each pixel the character covers. Without a
    background, `rgb` is the character's own colour, not multiplied by `alpha`, and black where it is not."""

    rgb: NDArray[np.uint8]
    alpha: NDArray[np.float32]


@dataclass(frozen=True)
class Subject:
    """A character made ready for drawing: `prepare` makes it, once for all frames."""

    mesh: SkinnedMesh
    mipmap: Mipmap
    spread: NDArray[np.float32]
    """(T,) the area of each triangle on the texture, texels."""
    point: NDArray[np.int32]
    """(V,) the point of the surface that each vertex is (`engine.geometry.welding.weld`)."""
    closed: bool
    """A ray enters a closed surface as often as it leaves it, however it is bent: the backs of its triangles need not
    be drawn, and every pixel is covered as before."""


def prepare(mesh: SkinnedMesh) -> Subject:
    """Whatever about a mesh does not change from frame to frame."""
    height, width = mesh.texture.shape[:2]
    a, b, c = (mesh.uv[mesh.triangles[:, k]] * np.array([width, height], np.float32) for k in range(3))
    p, q = b - a, c - a
    spread = np.abs(p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]) / 2
    point = weld(mesh)
    return Subject(mesh, build_mipmap(mesh.texture), spread.astype(np.float32), point, is_closed(point[mesh.triangles]))


def draw_character(
    subject: Subject,
    posed: NDArray[np.float32],
    camera: Camera,
    background: NDArray[np.uint8] | None = None,
    shadow: GroundShadow | None = None,
    samples: int = SAMPLES,
    shading: float = 0.0,
) -> Drawn:
    """Draw the character as its vertices `posed` (V, 3) stand.

    Parameters
    ----------
    background : (H, W, 3) sRGB of the camera's size; it is not changed.
    shadow : what the ground y = 0 receives, if there is a background.
    samples : to a pixel, along each axis.
    shading : how much darker the side turned away from `LIGHT` is, 0 to 1: none by default, since the texture already
        shows the light of its picture.
    """
    height, width = camera.size
    rgb = np.zeros((height, width, 3), np.uint8) if background is None else background.copy()
    if rgb.shape != (height, width, 3):
        raise ValueError(f"a background of {rgb.shape[1]} x {rgb.shape[0]} for a camera of {width} x {height}")
    alpha = np.zeros((height, width), np.float32)
    faces = subject.mesh.triangles
    if shadow is not None and background is not None:
        cast_on_ground(rgb, posed, faces, camera, shadow)
    points = camera.enlarged(samples).project(posed)
    box = _box(points, camera.size, samples)
    if box is not None:
        left, top, right, bottom = box
        points[:, 0] -= np.float32(left * samples)
        points[:, 1] -= np.float32(top * samples)
        ids = np.full(((bottom - top) * samples, (right - left) * samples), -1, np.int32)
        draw_into(points, faces, True, subject.closed, ids, np.full(ids.shape, np.inf, np.float32))
        inside = rgb[top:bottom, left:right], alpha[top:bottom, left:right]
        surface = points, faces, subject.mesh.uv, subject.spread, *subject.mipmap, _shade(subject, posed, shading)
        _resolve(*surface, ids, samples, background is None, *inside)
    return Drawn(rgb, alpha)


@dataclass(frozen=True)
class Actor:
    """Who acts in a film: a `subject`, its `clip`, and where the origin of its own world lies in the film's, `place` (3,)
    metres."""

    subject: Subject
    clip: Clip
    place: tuple[float, float, float] = (0.0, 0.0, 0.0)


def film_cast(
    cast: Sequence[Actor],
    camera_at: Callable[[float], Camera],
    background_at: Callable[[Camera], NDArray[np.uint8]],
    shadow: GroundShadow | None = None,
) -> Iterator[NDArray[np.uint8]]:
    """Characters acting, the later before the earlier: one frame (H, W, 3) of the film for each of the longest clip's; who
    has done stands still.

    `camera_at(second)` and `background_at(camera)` are called for each frame, side by side on all cores; of the
    length, only the joints' transforms are held (3 kB a frame). Resample the clips first where the film has another rate.
    """
    transforms = [pose_transforms(one.subject.mesh.skeleton, one.clip.rotations, one.clip.root) for one in cast]

    def draw(frame: int) -> NDArray[np.uint8]:
        camera = camera_at(frame / cast[0].clip.fps)
        picture = background_at(camera)
        for actor, moves in zip(cast, transforms, strict=True):
            mesh = actor.subject.mesh
            posed = skin(mesh.vertices, mesh.bones, mesh.weights, moves[min(frame, len(moves) - 1)])
            x, y, z = (np.array(camera.eye) - actor.place).tolist()
            picture = draw_character(actor.subject, posed, replace(camera, eye=(x, y, z)), picture, shadow).rgb
        return picture

    threads = os.cpu_count() or 1
    waiting: deque[Future[NDArray[np.uint8]]] = deque()
    with ThreadPoolExecutor(threads, thread_name_prefix="film") as pool:
        for frame in range(max(len(moves) for moves in transforms)):
            waiting.append(pool.submit(draw, frame))
            if len(waiting) > AHEAD * threads:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()


def _shade(subject: Subject, posed: NDArray[np.float32], shading: float) -> NDArray[np.float32]:
    """(V,) by what the texture is multiplied: from 1 towards the light to 1 - `shading` away from it."""
    if shading == 0:
        return np.ones(len(posed), np.float32)
    point = subject.point
    places = np.empty((int(point.max()) + 1, 3), np.float32)
    places[point] = posed
    normals = vertex_normals(places, point[subject.mesh.triangles])
    towards = np.array(LIGHT, np.float32) / np.linalg.norm(LIGHT)
    return (1 - shading * (1 - normals @ towards) / 2).astype(np.float32)[point]


def _box(points: NDArray[np.float32], size: tuple[int, int], samples: int) -> tuple[int, int, int, int] | None:
    """The pixels that points before the camera can touch: left, top, right, bottom (exclusive); None if there are
    none. `points` (V, 3) are in samples."""
    seen = points[points[:, 2] > 0, :2] / samples
    if not len(seen):
        return None
    limit = (size[1], size[0])
    low, high = np.floor(seen.min(0)) - 1, np.ceil(seen.max(0)) + 2
    left, top = (int(np.clip(low[k], 0, limit[k])) for k in range(2))
    right, bottom = (int(np.clip(high[k], 0, limit[k])) for k in range(2))
    return (left, top, right, bottom) if right > left and bottom > top else None


@njit(cache=True, nogil=True, fastmath=True, boundscheck=False, error_model="numpy")
def _colour(
    points: np.ndarray,
    faces: np.ndarray,
    t: int,
    uv: np.ndarray,
    spread: np.ndarray,
    texels: np.ndarray,
    starts: np.ndarray,
    sizes: np.ndarray,
    shade: np.ndarray,
    x: np.float32,
    y: np.float32,
    pixel: np.float32,
) -> tuple:
    """The texture where a triangle covers the sample (x, y), as sharp as a pixel of `pixel` samples can show it."""
    a, b, c = faces[t, 0], faces[t, 1], faces[t, 2]
    ax, ay = points[a, 0] - x, points[a, 1] - y
    bx, by = points[b, 0] - x, points[b, 1] - y
    cx, cy = points[c, 0] - x, points[c, 1] - y
    wa, wb, wc = bx * cy - by * cx, cx * ay - cy * ax, ax * by - ay * bx
    half, tiny = np.float32(0.5), np.float32(1e-6)
    level = half * np.log2((spread[t] * pixel + tiny) / (abs(wa + wb + wc) * half + tiny))
    wa /= points[a, 2]
    wb /= points[b, 2]
    wc /= points[c, 2]
    total = np.float32(1) / (wa + wb + wc)
    u = (wa * uv[a, 0] + wb * uv[b, 0] + wc * uv[c, 0]) * total
    v = (wa * uv[a, 1] + wb * uv[b, 1] + wc * uv[c, 1]) * total
    dark = (wa * shade[a] + wb * shade[b] + wc * shade[c]) * total
    red, green, blue = look_up(texels, starts, sizes, u, v, level)
    return dark * red, dark * green, dark * blue


@njit(cache=True, nogil=True, fastmath=True, boundscheck=False, error_model="numpy")
def _resolve(
    points: np.ndarray,
    faces: np.ndarray,
    uv: np.ndarray,
    spread: np.ndarray,
    texels: np.ndarray,
    starts: np.ndarray,
    sizes: np.ndarray,
    shade: np.ndarray,
    ids: np.ndarray,
    samples: int,
    alone: bool,
    rgb: np.ndarray,
    alpha: np.ndarray,
) -> None:
    """Each pixel gets the mean of its samples, over what `rgb` holds (or `alone`). The samples of a pixel that one
    triangle covers are coloured together, in their middle."""
    full, half = np.float32(samples * samples), np.float32(0.5)
    found = np.empty((samples * samples, 4), np.int32)  # the triangles in a pixel: which, how often, sums of x and y
    for y in range(rgb.shape[0]):
        for x in range(rgb.shape[1]):
            kinds, covered = 0, 0
            for sy in range(y * samples, (y + 1) * samples):
                for sx in range(x * samples, (x + 1) * samples):
                    t = ids[sy, sx]
                    if t < 0:
                        continue
                    k = kinds - 1
                    while k >= 0 and found[k, 0] != t:
                        k -= 1
                    if k < 0:
                        k = kinds
                        kinds += 1
                        found[k, 0], found[k, 1], found[k, 2], found[k, 3] = t, 0, 0, 0
                    found[k, 1] += 1
                    found[k, 2] += sx
                    found[k, 3] += sy
                    covered += 1
            red, green, blue = np.float32(0), np.float32(0), np.float32(0)
            for k in range(kinds):
                count = np.float32(found[k, 1])
                px, py = np.float32(found[k, 2]) / count, np.float32(found[k, 3]) / count
                r, g, b = _colour(points, faces, found[k, 0], uv, spread, texels, starts, sizes, shade, px, py, full)
                red, green, blue = red + count * r, green + count * g, blue + count * b
            if covered == 0:
                continue
            alpha[y, x] = np.float32(covered) / full
            if alone:
                rgb[y, x, 0] = int(red / covered + half)
                rgb[y, x, 1] = int(green / covered + half)
                rgb[y, x, 2] = int(blue / covered + half)
            else:
                rest = np.float32(1) - alpha[y, x]
                rgb[y, x, 0] = int(red / full + rest * rgb[y, x, 0] + half)
                rgb[y, x, 1] = int(green / full + rest * rgb[y, x, 1] + half)
                rgb[y, x, 2] = int(blue / full + rest * rgb[y, x, 2] + half)
