"""Contact sheets of portraits to look at.

    python -m benchmarks.portrait_figures.sheet -o DIR [--clips NAME...] [--portraits NAME...] [--options JSON]

One PNG for each driver: above what it does, under it every portrait of the test media, first at rest, then at the same six
moments. And `performances.png`: built-in performances beside real people in the same state, each over what a portrait makes
of it.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.presentation.contact_sheet import SHEET_GREY_LEVEL, Row, contact_sheet, fitted, write_sheet
from benchmarks.presentation.tables import machine
from benchmarks.shared_media import driving_clips, media
from engine.errors import InputError
from engine.media.image import read_image
from engine.media.video import read_video
from engine.performances import video
from galatea import animate

SHEET_CLIPS = ("woman_funny_faces_d6", "woman_frown_surprise_d3", "man_talk_tps")
SHEET_OPTIONS: Mapping[str, Any] = {"crop": "bust", "size": (640, 640)}
"""Near enough to see lids and lips, far enough to see shoulders and walls."""
ACTED_BY = "photo_woman_white"
COMPARED_PERFORMANCES = (
    ("happy", "man_grimace_d0", (0.0, 3.1)),
    ("happy-strong", "man_smile_d9", (1.5, 4.5)),
    ("surprise", "man_mouth_open_d18", (1.8, 3.5)),
    ("surprise-strong", "woman_funny_faces_d6", (5.9, 7.0)),
    ("idle", "woman_frown_surprise_d3", (2.0, 3.5)),
)
"""Performances, and the clips and seconds that `driver_segments.json` marks as the same."""
SHOWN_FRAMES = 6
"""Frames that are shown of each video."""
CELL_SIZE = (220, 220)
"""Height and width of a picture, pixels."""
Part = tuple[float, float] | None
"""Seconds of a video; None is the whole."""


def drivers(out: Path, clips: Sequence[str], portraits: Sequence[str], options: Mapping[str, Any]) -> None:
    """A sheet for each driver."""
    chosen = [path for path in sorted(media("portraits").iterdir()) if any(name in path.name for name in portraits)]
    with TemporaryDirectory() as cache:
        for clip in driving_clips(clips):
            rows = [_driven(clip.stem, clip)]
            for picture in chosen:
                try:
                    rows.append(_acted(picture, clip, options, Path(cache)))
                except InputError as error:
                    print(f"{picture.stem} by {clip.stem}: {error.code}")
            write_sheet(out / f"{clip.stem}.png", contact_sheet(rows, CELL_SIZE))


def performances(out: Path, options: Mapping[str, Any]) -> None:
    """The sheet of built-in performances beside real ones."""
    (picture,) = media("portraits").glob(f"{ACTED_BY}.*")
    rows = []
    with TemporaryDirectory() as cache:
        for name, clip, part in COMPARED_PERFORMANCES:
            real = media(f"driving/{clip}.mp4")
            rows += [_driven(f"built in: {name}", video(name)), _acted(picture, video(name), options, Path(cache))]
            rows.append(_driven(f"real: {clip}, {part[0]} to {part[1]} s", real, part))
            rows.append(_acted(picture, real, options, Path(cache), part))
    write_sheet(out / "performances.png", contact_sheet(rows, CELL_SIZE))


def _driven(label: str, driver: Path, part: Part = None) -> Row:
    return Row([np.full((1, 1, 3), SHEET_GREY_LEVEL, np.uint8), *_frames(driver, part)], label)


def _acted(picture: Path, driver: Path, options: Mapping[str, Any], cache: Path, part: Part = None) -> Row:
    """The portrait at rest, and what it makes of a part of the driver."""
    with TemporaryDirectory() as folder:
        made = animate(picture, driver, folder, cache=cache, **options).path
        rest = read_image(Path(folder) / "preview.jpg").rgb
        return Row([rest, *_frames(made, part)], picture.stem)


def _frames(path: Path, part: Part) -> list[NDArray[np.uint8]]:
    """`SHOWN_FRAMES` frames of a part of a video, evenly spread."""
    frames = [fitted(frame.rgb, CELL_SIZE) for frame in read_video(path, trim=part)]
    return [frames[int((k + 0.5) * len(frames) / SHOWN_FRAMES)] for k in range(SHOWN_FRAMES)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--out", type=Path, required=True, metavar="DIR")
    parser.add_argument("--clips", nargs="+", default=SHEET_CLIPS, metavar="NAME", help="drivers by part of their name")
    parser.add_argument("--portraits", nargs="+", default=[""], metavar="NAME", help="portraits by part of their name")
    parser.add_argument("--options", type=json.loads, default={}, metavar="JSON")
    asked = parser.parse_args()
    print(machine())
    options = {**SHEET_OPTIONS, **asked.options}
    drivers(asked.out, asked.clips, asked.portraits, options)
    performances(asked.out, options)


if __name__ == "__main__":
    main()
