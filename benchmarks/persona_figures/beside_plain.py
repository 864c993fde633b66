"""A person's composite beside what a user would do instead: the same photo that acts by itself.

    python -m benchmarks.persona_figures.beside_plain OUT [--collections NAME ...] [--clips NAME ...]

Films and sheets of each collection and driver are left in OUT. On a sheet the two are A and B, in an order that differs from
sheet to sheet, so that who looks does not know which is which; `which.txt` tells. The table has how far each film's face is from
the person's photographs by the descriptor that tells people apart.
"""

from __future__ import annotations

import argparse
import os
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.presentation.contact_sheet import SHEET_GREY_LEVEL, Row, contact_sheet, write_sheet
from benchmarks.presentation.tables import table
from benchmarks.shared_media import driving_clips, media
from engine.media.image import read_image, write_image
from engine.media.video import read_video
from engine.perception.face.faces import FaceTracker
from engine.perception.face.landmarks import LIPS_OUTER, eye_opening, mouth_opening
from engine.perception.identity.backend import face_descriptor
from engine.persona.composite.framing import framed
from engine.persona.persona import Persona, read_persona
from galatea import animate, make_persona

PLAIN_CLIPS = ("man_smile_d9", "man_laugh_d12", "woman_wow_d10")
PLAYED_SECONDS = 4.0
"""Of a driver, from its beginning."""
FILM_SIZE = (600, 800)
"""Width and height at most."""
NEAREST_PHOTOS = 0.25
"""Share of the collection's photographs, those most alike, whose mean distance counts: no film is like all of them."""
DESCRIBED_STEP_FRAMES = 6
"""From one frame that is described to the next."""
LOOKED_FRAMES = 6
"""Moments of a sheet."""
FACE_CELL, MOUTH_CELL = (300, 300), (200, 300)
"""Height and width of a face and of a mouth on a sheet, pixels."""
FACE_WIDTHS, MOUTH_WIDTHS = 1.25, 1.7
"""Of a face's, and of a mouth's own width, that a cell shows."""

Picture = NDArray[np.uint8]
Mesh = NDArray[np.floating]


@dataclass(frozen=True)
class Film:
    """A film's frames, (h, w, 3) each, the seconds at which they are shown, and the meshes (478, 3) of their faces; None where none is found."""

    frames: list[Picture]
    seconds: NDArray[np.float64]
    meshes: list[Mesh | None]


def beside_plain(out: Path, collections: Sequence[str], clips: Sequence[str]) -> None:
    """Make the films that are not there yet, the sheets, and print the table."""
    folders = [one for one in sorted(media("collections").iterdir()) if one.is_dir()]
    rows, order = [], []
    for folder in [one for one in folders if not collections or any(name in one.name for name in collections)]:
        persona = _persona(folder, out / folder.name)
        known = _known_descriptors(folder)
        assert persona.portrait is not None
        photo = out / folder.name / "photo.png"
        write_image(photo, framed(persona.portrait, FILM_SIZE).rgb)
        for clip in driving_clips(list(clips) or PLAIN_CLIPS):
            paths = _films(out / folder.name, photo, clip)
            persona_film, plain_film, driver = (_film(path) for path in (*paths, clip))
            far, plain = (distance_to_person(film, known) for film in (persona_film, plain_film))
            rows.append([folder.name, clip.stem, f"{far:.3f}", f"{plain:.3f}", f"{far - plain:+.3f}"])
            swapped = bool(zlib.crc32(f"{folder.name} {clip.stem}".encode()) & 1)
            pair = (plain_film, persona_film) if swapped else (persona_film, plain_film)
            write_sheet(out / f"{folder.name}_{clip.stem}.png", pair_sheet(driver, *pair))
            order.append(f"{folder.name} {clip.stem}: A is the {'plain' if swapped else 'persona'}")
    (out / "which.txt").write_text("\n".join(order) + "\n")
    head = ["collection", "driver", "persona", "photo by itself", "difference"]
    print(table("Distance to the person's photographs", head, rows))
    differences = [float(row[-1]) for row in rows]
    print(f"\ndifference: median {np.median(differences):+.3f} (goal 0), at most {max(differences):+.3f} (goal 0.02)")


def pair_sheet(driver: Film, first: Film, second: Film) -> Picture:
    """A sheet (H, W, 3) of two films, A and B, at the moments at which a driver's mouth and eyes are at their extremes: faces, then mouths."""
    extremes = extreme_moments([None if mesh is None else _expression(mesh) for mesh in driver.meshes], LOOKED_FRAMES)
    moments = driver.seconds[extremes]
    films = {"driver": driver, "A": first, "B": second}
    rows = [Row([_face(film, at) for at in moments], title) for title, film in films.items()]
    rows += [Row([_mouth(film, at) for at in moments], f"{title}, mouths") for title, film in films.items()]
    return contact_sheet(rows)


def extreme_moments(expressions: Sequence[NDArray[np.floating] | None], count: int) -> list[int]:
    """The `count` frames, in their order, whose `expressions` (K,) lie farthest apart: each next one is the farthest from all before."""
    numbers = [number for number, one in enumerate(expressions) if one is not None]
    known = np.array([expressions[number] for number in numbers])
    known = (known - known.mean(axis=0)) / np.maximum(known.std(axis=0), 1e-6)
    chosen = [int(np.argmax(np.linalg.norm(known, axis=1)))]
    while len(chosen) < min(count, len(numbers)):
        apart = np.linalg.norm(known[:, None] - known[chosen], axis=2).min(axis=1)
        chosen.append(int(np.argmax(apart)))
    return sorted(numbers[one] for one in chosen)


def distance_to_person(film: Film, known: NDArray[np.floating]) -> float:
    """The mean, over frames, of a face's mean distance to those of the `known` descriptors (N, D) that are nearest."""
    describe = face_descriptor(os.environ)
    count = max(1, round(NEAREST_PHOTOS * len(known)))
    found = [
        float(np.sort(np.linalg.norm(known - describe(frame, mesh), axis=1))[:count].mean())
        for frame, mesh in list(zip(film.frames, film.meshes, strict=True))[::DESCRIBED_STEP_FRAMES]
        if mesh is not None
    ]
    return float(np.mean(found))


def _persona(photos: Path, out: Path) -> Persona:
    if not (out / "persona.npz").exists():
        make_persona(photos, None, out)
    return read_persona(out / "persona.npz")


def _known_descriptors(photos: Path) -> NDArray[np.float32]:
    describe, found = face_descriptor(os.environ), []
    with FaceTracker(alone=True) as tracker:
        for path in sorted(photos.iterdir()):
            rgb = read_image(path).rgb
            found += [describe(rgb, mesh) for mesh in tracker(rgb)[:1]]
    return np.array(found)


def _films(out: Path, photo: Path, clip: Path) -> tuple[Path, Path]:
    """The composite, and the photo that acts by itself."""
    persona, plain = out / f"persona_{clip.stem}", out / f"plain_{clip.stem}"
    cache = out / "cache"
    if not (persona / "animation.mp4").exists():
        kept = out / "persona.npz"
        make_persona(kept, clip, persona, cache=cache, composite="photo", trim=(0.0, PLAYED_SECONDS), size=FILM_SIZE)
    if not (plain / "animation.mp4").exists():
        animate(photo, clip, plain, cache=cache, crop="none", trim=(0.0, PLAYED_SECONDS), size=FILM_SIZE)
    return persona / "animation.mp4", plain / "animation.mp4"


def _film(path: Path) -> Film:
    """As much of a video as is played of a driver."""
    shown = [(one.rgb.copy(), one.time) for one in read_video(path, trim=(0.0, PLAYED_SECONDS))]
    with FaceTracker(alone=True) as tracker:
        meshes = [next(iter(tracker(rgb)), None) for rgb, _ in shown]
    return Film([rgb for rgb, _ in shown], np.array([time for _, time in shown]), meshes)


def _expression(mesh: Mesh) -> NDArray[np.float64]:
    """(4,) the opening of the mouth and of both eyes, and the mouth's width by the face's."""
    width = np.ptp(mesh[list(LIPS_OUTER), 0]) / np.ptp(mesh[:, 0])
    return np.array([float(mouth_opening(mesh)), *np.ravel(eye_opening(mesh)), float(width)])


def _face(film: Film, moment: float) -> Picture:
    return _cell(film, moment, slice(None), FACE_WIDTHS, FACE_CELL)


def _mouth(film: Film, moment: float) -> Picture:
    return _cell(film, moment, list(LIPS_OUTER), MOUTH_WIDTHS, MOUTH_CELL)


def _cell(film: Film, moment: float, vertices: slice | list[int], widths: float, cell: tuple[int, int]) -> Picture:
    """What is around some vertices in the frame of a moment in seconds; black where no face is found."""
    number = int(np.argmin(np.abs(film.seconds - moment)))
    mesh = film.meshes[number]
    if mesh is None:
        return np.zeros((*cell, 3), np.uint8)
    low, high = mesh[vertices, :2].min(axis=0), mesh[vertices, :2].max(axis=0)
    scale = cell[1] / (widths * float(high[0] - low[0]))
    shift = np.array(cell[::-1]) / 2 - scale * (low + high) / 2
    matrix = np.array([[scale, 0, shift[0]], [0, scale, shift[1]]])
    way = cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC
    beyond = (SHEET_GREY_LEVEL,) * 3
    return np.asarray(cv2.warpAffine(film.frames[number], matrix, cell[::-1], flags=way, borderValue=beyond), np.uint8)


def main() -> None:
    """Read the command line, make the films and print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--collections", nargs="+", default=[], metavar="NAME", help="by part of their name")
    parser.add_argument("--clips", nargs="+", default=[], metavar="NAME", help=f"default: {', '.join(PLAIN_CLIPS)}")
    given = parser.parse_args()
    beside_plain(given.out, given.collections, given.clips)


if __name__ == "__main__":
    main()
