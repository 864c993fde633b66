"""Characters to be reviewed: each from its sides, its head from near, and arms and legs away from the body.

    python -m benchmarks.character_figures.review_sheet PICTURE... -o FOLDER [--kept FOLDER] [--again STAGE] [--options JSON]

Writes a sheet of each picture and its front's PSNR against the picture. What stages find is kept, and where `--again`
names one, it and those after it are run anew whatever is kept: code that was changed.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.character_figures.steps import options_for
from benchmarks.presentation.contact_sheet import Row, contact_sheet, fitted, write_sheet
from engine.character.film.person import Person
from engine.character.pipeline import STAGES, cut_all_out, find_figures, reconstruct
from engine.character.rig.measures import picture_camera, pose
from engine.geometry.camera import Camera
from engine.motion.clip import Clip
from engine.motion.edit import in_place
from engine.motion.library import built_in
from engine.render.scene.character import PreparedCharacter, draw_character, prepare_character
from engine.run import Run
from engine.store import StageStore

T = TypeVar("T")

WHOLE_SIZE, HEAD_SIZE = (560, 350), (420, 350)
"""Height and width, pixels, of pictures of all of somebody and of the head."""
HEAD_METRES = 0.42
"""Metres that the height of a head's picture shows."""
BACKDROP_GREY_LEVEL = 150
"""Grey level behind a drawn character."""
LIGHT_SHARE = 0.25
"""Share of the light that comes from the camera; the rest is everywhere."""
SIDES_DEGREES = (0, 40, 90, 180, -90)
"""Turns of the camera about the character as pictured."""
HEAD_SIDES_DEGREES = (0, 40, 90, -40, -90, 180)
"""Turns of the camera about the head."""
MOMENTS = (("walk", 0.0, 30), ("walk", 0.5, -60), ("wave", 0.5, 0), ("wave", 0.5, 150), ("dance", 0.6, 20))
"""Clips, how far along them they are shown, and the turn of the camera, degrees."""
CAMERA_DISTANCE_HEIGHTS = 3.0
"""How far the camera is, in heights of what it shows."""


class RunFrom(Run):
    """A run in which a stage, and what follows it, is never taken from what is kept."""

    def __init__(self, kept: StageStore, first: str | None) -> None:
        super().__init__(store=kept)
        names = list(STAGES)
        self.again = names[names.index(first) :] if first else []

    def stage(
        self, name: str, function: Callable[..., T], *arguments: Any, shared: bool = False, stored: bool = True
    ) -> T:
        return super().stage(name, function, *arguments, shared=shared, stored=stored and name not in self.again)


def woken(photo: Path, options: Mapping[str, Any], kept: StageStore, first: str | None) -> Person:
    """The one who is pictured, from the stage `first` on made anew."""
    asked = options_for(photo, options)
    with RunFrom(kept, first) as run:
        figures, silhouettes = cut_all_out(find_figures(photo, asked, run), None, asked, run)
        return reconstruct(figures[0], silhouettes[0], None, asked, run)


def review_sheet(person: Person) -> NDArray[np.uint8]:
    """The sheet (H, W, 3) of a character."""
    character = person.character
    subject = prepare_character(character.mesh)
    standing = pose(character, character.pictured)
    head = _head(person, standing)
    whole = [fitted(person.figure.rgb, WHOLE_SIZE)] + [_seen(subject, standing, turn) for turn in SIDES_DEGREES]
    heads = [_seen(subject, standing, turn, head) for turn in HEAD_SIDES_DEGREES]
    acting = [_seen(subject, _posed(person, name, share), turn) for name, share, turn in MOMENTS]
    return contact_sheet([Row(whole), Row(acting), Row(heads)])


def front_psnr(person: Person) -> float:
    """Decibels by which the character as pictured is like the picture, where both show the person."""
    rgb, alpha = person.figure.rgb, person.silhouette.alpha
    camera = picture_camera(person.character, person.fitted, (rgb.shape[0], rgb.shape[1]))
    standing = pose(person.character, person.character.pictured)
    drawn = draw_character(prepare_character(person.character.mesh), standing, camera)
    inside = (alpha > 0.95) & (drawn.alpha > 0.95)
    error = ((drawn.rgb[inside].astype(np.float64) - rgb[inside]) ** 2).mean()
    return float(10 * np.log10(255**2 / max(error, 1e-9)))


def _posed(person: Person, name: str, share: float) -> NDArray[np.float32]:
    """(V, 3) the vertices so far along a built-in clip, on the spot."""
    clip: Clip = in_place(built_in(name, person.character.mesh.skeleton))
    return pose(person.character, clip, int(share * (len(clip.rotations) - 1)))


def _head(person: Person, standing: NDArray[np.float32]) -> NDArray[np.float64]:
    """(3,) the middle of the head as pictured."""
    mesh = person.character.mesh
    own = (mesh.weights * (mesh.bones == mesh.skeleton.names.index("Head"))).sum(1) > 0.5
    return np.asarray((standing[own].max(0) + standing[own].min(0)) / 2, np.float64)


def _seen(
    subject: PreparedCharacter, posed: NDArray[np.float32], degrees: float, head: NDArray[np.float64] | None = None
) -> NDArray[np.uint8]:
    """The vertices `posed` (V, 3) from a side: all of them, or what is about the `head`."""
    height, width = WHOLE_SIZE if head is None else HEAD_SIZE
    middle = (posed.max(0) + posed.min(0)) / 2 if head is None else head
    shown = 1.15 * max(float(np.ptp(posed[:, 1])), 1.6 * float(np.ptp(posed[:, 0]))) if head is None else HEAD_METRES
    turn = np.radians(degrees)
    away = CAMERA_DISTANCE_HEIGHTS * shown
    eye = middle + away * np.array([np.sin(turn), 0.06, np.cos(turn)])
    size = (2 * height, 2 * width)
    lens = Camera((0, 0, 0), CAMERA_DISTANCE_HEIGHTS * size[0], ((size[1] - 1) / 2, (size[0] - 1) / 2), size)
    backdrop = np.full((*size, 3), BACKDROP_GREY_LEVEL, np.uint8)
    drawn = draw_character(subject, posed, lens.aimed(eye, middle), backdrop, shading=LIGHT_SHARE).rgb
    return np.asarray(cv2.resize(drawn, (width, height), interpolation=cv2.INTER_AREA))


def main() -> None:
    """Wake, draw and write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pictures", nargs="+", type=Path)
    parser.add_argument("-o", "--out", type=Path, required=True)
    parser.add_argument("--kept", type=Path, help="where to keep what stages find; beside the sheets by default")
    parser.add_argument("--again", choices=list(STAGES))
    parser.add_argument("--options", type=json.loads, default={})
    asked = parser.parse_args()
    kept = StageStore(asked.kept or asked.out / "kept")
    for picture in asked.pictures:
        began = time.perf_counter()
        person = woken(picture, asked.options, kept, asked.again)
        write_sheet(asked.out / f"{picture.stem}.png", review_sheet(person))
        print(f"{picture.stem} {front_psnr(person):.2f} dB, {time.perf_counter() - began:.1f} s", flush=True)


if __name__ == "__main__":
    main()
