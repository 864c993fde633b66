"""Close-ups of portraits to look at: eyes and mouths, enlarged, where the driver shuts, parts and opens them.

    python -m benchmarks.portrait_figures.close_ups -o DIR --clip NAME --part START END [--portraits NAME...] [--options JSON]

Two PNGs for each portrait, at six moments of the driver. `NAME.png` has it above what the portrait makes of it, and `NAME_near.png` the eyes and
the mouth of both. Printed is by how much further the irises of its two eyes part than in the picture.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.portrait_figures.sheet import SHEET_OPTIONS
from benchmarks.presentation.contact_sheet import Row, contact_sheet, write_sheet
from benchmarks.presentation.tables import table
from benchmarks.shared_media import driving_clips, media
from engine.errors import InputError
from engine.face_animation.eyes.gaze import INWARD_SIGNS, iris_positions
from engine.media.image import read_image
from engine.media.video import read_video
from engine.perception.face.faces import FaceTracker
from engine.perception.face.landmarks import (
    LEFT_EYE,
    LIPS_OUTER,
    MOUTH_CORNER_VERTICES,
    RIGHT_EYE,
    eye_distance,
    eye_opening,
    mouth_opening,
)
from galatea import animate

WHOLE_CELL, EYES_CELL, MOUTH_CELL = (320, 320), (150, 400), (260, 400)
"""Height and width of a whole picture, of both eyes, and of a mouth, pixels."""
EYES_REACH_EYE_DISTANCES, MOUTH_REACH_EYE_DISTANCES = 1.9, 1.3
"""Eye distances across what is shown of eyes and of a mouth."""
MIN_SEEN_OPENING = 0.17
"""Opening of both eyes from which on the tracker sees where their irises are."""
Faces = NDArray[np.floating]
Frames = Sequence[NDArray[np.uint8]]


def close_ups(
    out: Path, clip: Path, part: tuple[float, float], portraits: Sequence[str], options: Mapping[str, Any]
) -> None:
    """Write the sheets of all portraits, and print how far their irises part."""
    frames, faces = tracked(clip, part)
    shown = moments(faces)
    rows = []
    with TemporaryDirectory() as cache:
        for picture in sorted(media("portraits").iterdir()):
            if not any(name in picture.name for name in portraits):
                continue
            try:
                made, seen, rest = _acted(picture, clip, part, options, Path(cache))
            except InputError as error:
                print(f"{picture.stem} by {clip.stem}: {error.code}")
                continue
            name = f"{picture.stem}_{clip.stem.split('_')[1]}"
            both = ((frames, faces), (made, seen))
            whole = [Row([one[k] for k in shown]) for one, _ in both]
            near = [Row([_cut(one[k], at[k], area) for k in shown]) for area in (_eyes, _mouth) for one, at in both]
            write_sheet(out / f"{name}.png", contact_sheet(whole, WHOLE_CELL))
            write_sheet(out / f"{name}_near.png", contact_sheet(near))
            rows.append([picture.stem, *(f"{value:.3f}" for value in irises_apart(seen, rest))])
    print(table(f"Irises by {clip.stem}", ["portrait", "along", "across", "worst tenth along"], rows))
    print(
        "\neye widths by which both irises stand further apart in their eyes than in the picture, along the eyes and across them."
    )


def tracked(video: Path, part: tuple[float, float] | None = None) -> tuple[Frames, Faces]:
    """The frames of a part of a video, and (N, 478, 3) the face in each; where none is seen, as before."""
    frames: list[NDArray[np.uint8]] = []
    faces: list[NDArray[np.floating]] = []
    with FaceTracker() as track:
        for frame in read_video(video, trim=part):
            found = track(frame.rgb)
            frames.append(frame.rgb)
            faces.append(found[0] if found else faces[-1])
    return frames, np.array(faces)


def moments(faces: Faces) -> list[int]:
    """Six frames of faces (N, 478, 3), in their order: eyes shut most, half, and wide; and the mouth open most, half, and wide in a smile."""
    eyes, mouth = eye_opening(faces).mean(axis=1), mouth_opening(faces)
    right, left = (faces[:, vertex, :2] for vertex in MOUTH_CORNER_VERTICES)
    width = np.linalg.norm(left - right, axis=1) / eye_distance(faces)
    wanted = [-eyes, -np.abs(eyes - (eyes.min() + eyes.max()) / 2), eyes]
    wanted += [mouth, -np.abs(mouth - (mouth.min() + mouth.max()) / 2), width]
    chosen: list[int] = []
    for scores in wanted:
        free = np.setdiff1d(np.arange(len(faces)), chosen)
        chosen.append(int(free[scores[free].argmax()]))
    return sorted(chosen)


def irises_apart(faces: Faces, rest: NDArray[np.floating]) -> tuple[float, float, float]:
    """By how much further apart than at `rest` (478, 3) both irises of faces (N, 478, 3) stand in their openings, eye widths: along the eyes and across them
    in the mean, and along them in the worst tenth of frames. Irises that stand nearer to one another than at rest agree."""
    signs = np.hstack([INWARD_SIGNS, INWARD_SIGNS])
    now, usual = (np.abs(np.diff(iris_positions(one) * signs, axis=1)[:, 0]) for one in (faces, rest[None]))
    further = np.maximum(now - usual, 0)[eye_opening(faces).min(axis=1) > MIN_SEEN_OPENING]
    return (
        (*further.mean(axis=0).tolist(), float(np.percentile(further[:, 0], 90))) if len(further) else (0.0, 0.0, 0.0)
    )


def _acted(
    picture: Path, clip: Path, part: tuple[float, float], options: Mapping[str, Any], cache: Path
) -> tuple[Frames, Faces, NDArray[np.floating]]:
    """The frames that a portrait makes of a part of a driver, their faces, and its face at rest."""
    with TemporaryDirectory() as folder:
        made = animate(picture, clip, folder, cache=cache, trim=part, **options).path
        frames, faces = tracked(made)
        with FaceTracker() as track:
            return frames, faces, track(read_image(Path(folder) / "preview.jpg").rgb)[0]


def _eyes(face: NDArray[np.floating]) -> tuple[NDArray[np.floating], float, tuple[int, int]]:
    middle = face[[*RIGHT_EYE, *LEFT_EYE], :2].mean(axis=0)
    return middle, EYES_REACH_EYE_DISTANCES, EYES_CELL


def _mouth(face: NDArray[np.floating]) -> tuple[NDArray[np.floating], float, tuple[int, int]]:
    return face[list(LIPS_OUTER), :2].mean(axis=0), MOUTH_REACH_EYE_DISTANCES, MOUTH_CELL


def _cut(rgb: NDArray[np.uint8], face: NDArray[np.floating], area: Any) -> NDArray[np.uint8]:
    """What a picture shows of an area of its face (478, 3), enlarged to its cell."""
    middle, reach, (height, width) = area(face)
    scale = width / (reach * float(eye_distance(face)))
    place = np.array([[scale, 0, width / 2 - scale * middle[0]], [0, scale, height / 2 - scale * middle[1]]])
    return np.asarray(cv2.warpAffine(rgb, place, (width, height), flags=cv2.INTER_CUBIC), np.uint8)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--out", type=Path, required=True, metavar="DIR")
    parser.add_argument("--clip", required=True, metavar="NAME", help="the driver by part of its name")
    parser.add_argument("--part", type=float, nargs=2, required=True, metavar="SECONDS", help="of the driver")
    parser.add_argument("--portraits", nargs="+", default=[""], metavar="NAME", help="portraits by part of their name")
    parser.add_argument("--options", type=json.loads, default={}, metavar="JSON")
    asked = parser.parse_args()
    (clip,) = driving_clips([asked.clip])
    close_ups(asked.out, clip, tuple(asked.part), asked.portraits, {**SHEET_OPTIONS, **asked.options})


if __name__ == "__main__":
    main()
