"""The video: the person comes to life in the picture and walks out of it, over the background behind them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.fit.template_fit import FittedBody
from engine.character.rig.measures import picture_camera
from engine.character.rig.rigging import Character
from engine.geometry.camera import Camera
from engine.imaging.resample import even_size
from engine.motion.clip import Clip
from engine.render.lighting.ground_shadow import GroundShadow
from engine.render.scene.backdrop import Backdrop
from engine.render.scene.camera_moves import Move, camera_at
from engine.render.scene.character import Actor, film_cast, prepare_character

DEFAULT_VIDEO_PIXELS = 1280
"""Pixels of the video by default."""
WALL_BEHIND_METRES = 1.6
"""How far behind the person the picture's wall stands, metres."""


def film_size(
    size: tuple[int, int], asked: tuple[int, int] | None, longest: int = DEFAULT_VIDEO_PIXELS
) -> tuple[int, int]:
    """Even width and height of the video for a picture of `size` (width, height): fitted into what was asked for, else into
    the `longest` side."""
    limit = asked or (longest, longest)
    factor = min(limit[0] / size[0], limit[1] / size[1])
    if asked is None:
        factor = min(factor, 1.0)
    return even_size(size[0] * factor, size[1] * factor)


def film(
    people: Sequence[tuple[Character, Clip]],
    fitted: FittedBody,
    plate: NDArray[np.uint8],
    shadow: GroundShadow,
    move: Move,
    size: tuple[int, int],
    alone: bool = False,
) -> Iterator[NDArray[np.uint8]]:
    """The frames (h, w, 3) of the video; `size` (width, height). Characters with what they do, the one in the middle of the
    camera's interest first; `fitted` is the first one's. If they are to be seen `alone`, frames have their alpha, (h, w, 4)."""
    height, width = plate.shape[:2]
    main = people[0][0]
    camera = resized_camera(picture_camera(main, fitted, (height, width)), size)
    small = np.asarray(cv2.resize(plate, size, interpolation=cv2.INTER_AREA), np.uint8)
    backdrop = Backdrop(small, camera, float(main.eye[2]) + WALL_BEHIND_METRES)
    return film_cast(cast_of(people), moving_camera(main, camera, move), backdrop.seen_by, shadow, alone)


def moving_camera(
    main: Character, camera: Camera, move: Move, of: Character | None = None
) -> Callable[[float], Camera]:
    """The film's camera by second, which begins as `camera` and moves about `main`; in the world of another character, `of`,
    if `camera` is in that."""
    target = main.pictured.root[0] - (0 if of is None else main.eye - of.eye)
    return lambda second: camera_at(move, camera, target, second)


def cast_of(people: Sequence[tuple[Character, Clip]]) -> list[Actor]:
    """Who is furthest first, all in the world of the first of `people`: one camera took them all."""
    main = people[0][0]
    cast = []
    for character, clip in sorted(people, key=lambda one: -float(one[0].eye[2] - one[1].root[0, 2])):
        x, y, z = (main.eye - character.eye).tolist()
        cast.append(Actor(prepare_character(character.mesh), clip, (x, y, z)))
    return cast


def resized_camera(camera: Camera, size: tuple[int, int]) -> Camera:
    """The camera of the same picture, resized to `size` (width, height)."""
    factor = size[0] / camera.size[1]
    return replace(camera.scaled(factor), size=(size[1], size[0]))
