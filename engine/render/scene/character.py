"""Draws a character in a pose over a background: textured, with smooth edges and a soft shadow on the ground.

Nothing here starts threads of its own, and all inner loops let others run: frames are drawn side by side, one thread
each (`film_cast`).
"""

from __future__ import annotations

import os
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from engine.geometry.camera import Camera
from engine.geometry.mesh.adjacency import edge_table
from engine.geometry.mesh.surface import vertex_normals
from engine.geometry.mesh.welding import is_closed, weld
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import skin
from engine.motion.clip import Clip
from engine.motion.kinematics import pose_transforms
from engine.render.lighting.ground_shadow import GroundShadow, cast_on_ground
from engine.render.scene.scratch import Scratch
from engine.render.scene.surface import SAMPLES_PER_AXIS, Surface, draw_surface, triangle_spread
from engine.render.textures.mipmap import Mipmap, build_mipmap

LIGHT_DIRECTION = (0.35, 0.75, 0.55)
"""Direction towards the light of the optional shading, in the world."""

FRAMES_PER_THREAD = 2
"""Frames drawn or waiting for each thread."""


@dataclass(frozen=True)
class DrawnCharacter:
    """`rgb` (H, W, 3) uint8; `alpha` (H, W) float32 [0, 1]: how much of each pixel the character covers. Without a
    background, `rgb` is the character's own colour, not multiplied by `alpha`, and black where it is not."""

    rgb: NDArray[np.uint8]
    alpha: NDArray[np.float32]


@dataclass(frozen=True)
class PreparedCharacter:
    """A character made ready for drawing: `prepare_character` makes it, once for all frames."""

    mesh: SkinnedMesh
    mipmap: Mipmap
    spread: NDArray[np.float32]
    """(T,) the area of each triangle on the texture, texels."""
    point: NDArray[np.int32]
    """(V,) the point of the surface that each vertex is (`engine.geometry.mesh.welding.weld`)."""
    edges: NDArray[np.int32]
    """(E, 4) the edges of the surface, as `engine.geometry.mesh.adjacency.edge_table` gives them."""
    closed: bool
    """A ray enters a closed surface as often as it leaves it, however it is bent: the backs of its triangles need not
    be drawn, and every pixel is covered as before."""


def prepare_character(mesh: SkinnedMesh) -> PreparedCharacter:
    """Whatever about a mesh does not change from frame to frame."""
    point = weld(mesh)
    return PreparedCharacter(
        mesh,
        build_mipmap(mesh.texture),
        triangle_spread(mesh.triangles, mesh.uv, mesh.texture.shape),
        point,
        edge_table(mesh.triangles, point),
        is_closed(point[mesh.triangles]),
    )


def draw_character(
    subject: PreparedCharacter,
    posed: NDArray[np.float32],
    camera: Camera,
    background: NDArray[np.uint8] | None = None,
    shadow: GroundShadow | None = None,
    samples: int = SAMPLES_PER_AXIS,
    shading: float = 0.0,
) -> DrawnCharacter:
    """Draw the character as its vertices `posed` (V, 3) stand.

    Parameters
    ----------
    background : (H, W, 3) sRGB of the camera's size; it is not changed.
    shadow : what the ground y = 0 receives, if there is a background.
    samples : to a pixel, along each axis.
    shading : how much darker the side turned away from `LIGHT_DIRECTION` is, 0 to 1: none by default, since the texture already
        shows the light of its picture.
    """
    height, width = camera.size
    rgb = np.zeros((height, width, 3), np.uint8) if background is None else background.copy()
    if rgb.shape != (height, width, 3):
        raise ValueError(f"a background of {rgb.shape[1]} x {rgb.shape[0]} for a camera of {width} x {height}")
    if background is not None and shadow is not None:
        cast_on_ground(rgb, background, posed, subject.mesh.triangles, camera, shadow, subject.closed)
    alpha = _draw_over(rgb, background is None, subject, posed, camera, Scratch(), samples, shading)
    return DrawnCharacter(rgb, alpha)


def _draw_over(
    rgb: NDArray[np.uint8],
    alone: bool,
    subject: PreparedCharacter,
    posed: NDArray[np.float32],
    camera: Camera,
    scratch: Scratch,
    samples: int = SAMPLES_PER_AXIS,
    shading: float = 0.0,
) -> NDArray[np.float32]:
    """Draw into `rgb`, which holds the background or, where the character is drawn `alone`, nothing. The alpha that is
    returned is part of `scratch`."""
    mesh = subject.mesh
    surface = Surface(mesh.triangles, mesh.uv, subject.spread, subject.edges, subject.closed, subject.mipmap)
    shade = _shade(subject, posed, shading) if shading else None
    return draw_surface(rgb, alone, surface, camera.project(posed), scratch, samples, shade)


@dataclass(frozen=True)
class Actor:
    """Who acts in a film: a `subject`, its `clip`, and where the origin of its own world lies in the film's, `place` (3,)
    metres. `rest_at`: the vertices at rest (V, 3) float32 in a frame of the clip, where its shape changes, as a face's does;
    called side by side."""

    subject: PreparedCharacter
    clip: Clip
    place: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rest_at: Callable[[int], NDArray[np.float32]] | None = None


def film_cast(
    cast: Sequence[Actor],
    camera_at: Callable[[float], Camera],
    background_at: Callable[[Camera], NDArray[np.uint8]],
    shadow: GroundShadow | None = None,
    alone: bool = False,
) -> Iterator[NDArray[np.uint8]]:
    """Characters acting, the later before the earlier, and all before the shadows of all. One frame (H, W, 3) of the
    film is drawn for each of the longest clip's; who has done stands still.

    If they are `alone`, nothing is seen behind them and no shadow falls on it: frames are (H, W, 4), with alpha.

    `camera_at(second)` and `background_at(camera)` are called for each frame, side by side on all cores; of the
    length, only the joints' transforms are held (3 kB a frame). Resample the clips first where the film has another rate.
    """
    transforms = [pose_transforms(one.subject.mesh.skeleton, one.clip.rotations, one.clip.root) for one in cast]

    own = threading.local()

    def draw(frame: int) -> NDArray[np.uint8]:
        camera = camera_at(frame / cast[0].clip.fps)
        background = background_at(camera)
        picture = background.copy()
        if not hasattr(own, "scratch"):
            own.scratch = Scratch()
        standing, cover = [], None
        for actor, moves in zip(cast, transforms, strict=True):
            subject, mesh = actor.subject, actor.subject.mesh
            now = min(frame, len(moves) - 1)
            rest = mesh.vertices if actor.rest_at is None else actor.rest_at(now)
            posed = skin(rest, mesh.bones, mesh.weights, moves[now])
            x, y, z = (np.array(camera.eye) - actor.place).tolist()
            standing.append((subject, posed, replace(camera, eye=(x, y, z))))
        for subject, posed, seen_from in standing:
            if shadow is not None and not alone:
                cast_on_ground(picture, background, posed, subject.mesh.triangles, seen_from, shadow, subject.closed)
        for subject, posed, seen_from in standing:
            alpha = _draw_over(picture, False, subject, posed, seen_from, own.scratch)
            if alone:
                cover = alpha.copy() if cover is None else alpha + (1 - alpha) * cover
        return picture if cover is None else _without(background, picture, cover)

    threads = os.cpu_count() or 1
    waiting: deque[Future[NDArray[np.uint8]]] = deque()
    with ThreadPoolExecutor(threads, thread_name_prefix="film") as pool:
        for frame in range(max(len(moves) for moves in transforms)):
            waiting.append(pool.submit(draw, frame))
            if len(waiting) > FRAMES_PER_THREAD * threads:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()


def _without(
    background: NDArray[np.uint8], picture: NDArray[np.uint8], cover: NDArray[np.float32]
) -> NDArray[np.uint8]:
    """What covers a background by so much (H, W), in its own colours and with alpha: (H, W, 4)."""
    alpha = cover[..., None]
    own = (picture - (1 - alpha) * background) / np.maximum(alpha, np.float32(1 / 255))
    return (np.dstack([np.clip(own, 0, 255), cover * 255]) + np.float32(0.5)).astype(np.uint8)


def _shade(subject: PreparedCharacter, posed: NDArray[np.float32], shading: float) -> NDArray[np.float32]:
    """(V,) by what the texture is multiplied: from 1 towards the light to 1 - `shading` away from it."""
    point = subject.point
    places = np.empty((int(point.max()) + 1, 3), np.float32)
    places[point] = posed
    normals = vertex_normals(places, point[subject.mesh.triangles])
    towards = np.array(LIGHT_DIRECTION, np.float32) / np.linalg.norm(LIGHT_DIRECTION)
    return (1 - shading * (1 - normals @ towards) / 2).astype(np.float32)[point]
