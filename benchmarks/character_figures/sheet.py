"""Contact sheets to look at: a row for each picture, of what was found in it and of the character from all sides.

    python -m benchmarks.character_figures.sheet PICTURE... -o SHEET.png [--options JSON]

From left to right come the picture, its mask and its labels. Then comes the character as pictured, from the front, the
side and behind. Four frames of the walk follow, two of the dance, and one of the wave.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.character_figures.steps import Woken, wake
from benchmarks.presentation.contact_sheet import Row, at_height, contact_sheet, write_sheet
from benchmarks.presentation.tables import machine
from engine.character.figure.strokes import LABEL_COLOURS
from engine.character.rig.measures import measure, pose
from engine.geometry.camera import Camera
from engine.motion.clip import Clip
from engine.motion.edit import in_place
from engine.motion.library import built_in
from engine.render.scene.character import draw_character, prepare_character

ROW_HEIGHT_PIXELS = 420
"""Pixels of a row."""
BACKDROP_RGB = np.array([150, 156, 162], np.uint8)
"""RGB behind a drawn character."""
SHOWN_CLIP_MOMENTS = (
    ("walk", 0.0),
    ("walk", 0.25),
    ("walk", 0.5),
    ("walk", 0.75),
    ("dance", 0.3),
    ("dance", 0.6),
    ("wave", 0.5),
)
"""Clips, and how far along them they are shown, as a share."""


def row(woken: Woken, title: str) -> Row:
    """The pictures of one character, `ROW_HEIGHT_PIXELS` pixels high."""
    figure, silhouette, character = woken.figure, woken.silhouette, woken.character
    subject = prepare_character(character.mesh)
    labels = LABEL_COLOURS[woken.labels.labels.astype(int)]
    mask = np.repeat((silhouette.alpha * 255).astype(np.uint8)[..., None], 3, 2)
    panels = [at_height(picture, ROW_HEIGHT_PIXELS) for picture in (figure.rgb, mask, labels)]

    def view(clip: Clip, frame: int, degrees: float) -> NDArray[np.uint8]:
        posed = pose(character, clip, frame)
        middle = (posed.max(0) + posed.min(0)) / 2
        high = float(posed[:, 1].max() - posed[:, 1].min())
        turn = np.radians(degrees)
        eye = middle + 3 * high * np.array([np.sin(turn), 0.1, np.cos(turn)])
        size = (ROW_HEIGHT_PIXELS, ROW_HEIGHT_PIXELS * 5 // 8)
        plain = Camera((0, 0, 0), 2.7 * ROW_HEIGHT_PIXELS, ((size[1] - 1) / 2, (size[0] - 1) / 2), size)
        return draw_character(
            subject, posed, plain.aimed(eye, middle), np.tile(BACKDROP_RGB, (*size, 1)), shading=0.25
        ).rgb

    panels += [view(character.pictured, 0, degrees) for degrees in (0, 90, 180)]
    for name, share in SHOWN_CLIP_MOMENTS:
        clip = in_place(built_in(name, character.mesh.skeleton))
        panels.append(view(clip, int(share * len(clip.rotations)), 25))
    return Row(panels, title)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pictures", nargs="+", type=Path)
    parser.add_argument("-o", "--out", type=Path, required=True)
    parser.add_argument("--options", type=json.loads, default={})
    asked = parser.parse_args()
    rows = []
    print(machine())
    for picture in asked.pictures:
        start = time.perf_counter()
        woken = wake(picture, asked.options)
        took = time.perf_counter() - start
        print(
            picture.stem,
            f"{took:.1f} s",
            measure(woken.figure, woken.silhouette, woken.fitted, woken.character).figures,
        )
        rows.append(row(woken, picture.stem))
    write_sheet(asked.out, contact_sheet(rows))


if __name__ == "__main__":
    main()
