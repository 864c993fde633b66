"""The film of a character, stage by stage: what a frame costs as the person walks up until they fill the picture.

    python -m benchmarks.character_film PICTURE... [--seconds 8]

At 720p, upright or lying as the picture is. The first table is processor time in milliseconds a frame, each stage in its
own thread, which other work on the machine touches least; "drawn" is their sum, "encoded" the same frames written again,
from memory: the floor. The second is what all cores do together.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.character_figures.steps import wake
from benchmarks.presentation.tables import machine, table
from engine.character.film.background import fill_background
from engine.character.film.cast_shadow import ground_shadow
from engine.character.film.film import film, film_size
from engine.character.film.motions import MotionChoice, choose_motion
from engine.character.rig.measures import picture_camera
from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.geometry.rigging.skinning import skin
from engine.render.lighting.ground_shadow import cast_on_ground
from engine.render.rasterisation.multisampling import draw_samples, select_pixels
from engine.render.rasterisation.outline import facings, mark_outline
from engine.render.rasterisation.rasteriser import draw_into
from engine.render.scene import character as renderer
from engine.render.textures.texturing import colour_inside, colour_samples, corner_table

FILM_FPS = 30.0
"""Frames a second of the film."""
STAGE_FUNCTIONS: Mapping[str, tuple[Any, ...]] = {
    "posed": (skin,),
    "shadow": (cast_on_ground,),
    "triangles": (draw_into,),
    "outline": (facings, mark_outline),
    "inside": (corner_table, colour_inside),
    "edges": (select_pixels, draw_samples, colour_samples),
}
"""The functions that `engine.render.scene.character` calls for each column; imported, so that mypy knows where one is renamed."""
END_FRAMES = 5
"""Frames at the beginning and at the end for which the cost is told apart."""


@contextmanager
def timed(spent: dict[str, list[float]]) -> Iterator[None]:
    """Adds the seconds of processor time that each call of the stages takes to `spent`."""
    names = [one.__name__ for functions in STAGE_FUNCTIONS.values() for one in functions]
    before = {name: getattr(renderer, name) for name in (*names, "_draw_over")}

    def counted(name: str) -> Callable[..., Any]:
        def call(*given: Any) -> Any:
            started = time.thread_time()
            result = before[name](*given)
            spent[name].append(time.thread_time() - started)
            return result

        return call

    for name in before:
        setattr(renderer, name, counted(name))
    try:
        yield
    finally:
        for name, own in before.items():
            setattr(renderer, name, own)


def encode(frames: list[NDArray[np.uint8]], folder: Path) -> tuple[float, float, int]:
    """(processor seconds, seconds, bytes) of writing a video."""
    height, width = frames[0].shape[:2]
    path, worked, started = folder / "film.mp4", time.process_time(), time.perf_counter()
    with VideoWriter(VideoTarget(path, (width, height), FILM_FPS)) as writer:
        for frame in frames:
            writer.write(frame)
    return time.process_time() - worked, time.perf_counter() - started, path.stat().st_size


def measure(photo: Path, seconds: float, folder: Path) -> tuple[list[list[str]], list[str]]:
    """The rows of both tables."""
    woken = wake(photo, {})
    background = fill_background(woken.figure, (woken.silhouette,))
    shadow = ground_shadow(background.shadow, woken.character, woken.fitted)
    height, width = woken.figure.rgb.shape[:2]
    camera = picture_camera(woken.character, woken.fitted, (height, width))
    choice = MotionChoice("walk", None, (), seconds, FILM_FPS)
    clip = choose_motion(woken.character, lambda second: camera, woken.character.pictured, choice).film
    size = film_size((width, height), (1280, 720) if width > height else (720, 1280))

    def drawn() -> Iterator[NDArray[np.uint8]]:
        return film([(woken.character, clip)], woken.fitted, background.rgb, shadow, "fixed", size)

    next(drawn())  # compiles
    spent: dict[str, list[float]] = defaultdict(list)
    with timed(spent):
        frames = list(drawn())
    worked, alone, size_bytes = encode(frames, folder)
    whole = time.process_time(), time.perf_counter()
    with VideoWriter(VideoTarget(folder / "whole.mp4", size, FILM_FPS)) as writer:
        for frame in drawn():
            writer.write(frame)
    cost, took = time.process_time() - whole[0], time.perf_counter() - whole[1]
    rows = []
    count = len(frames)
    for label, part in (
        ("first", slice(0, END_FRAMES)),
        ("last", slice(count - END_FRAMES, count)),
        ("mean", slice(None)),
    ):
        stages = [
            sum(float(np.mean(spent[one.__name__][part])) for one in functions)
            for functions in STAGE_FUNCTIONS.values()
        ]
        total = stages[0] + stages[1] + float(np.mean(spent["_draw_over"][part]))
        encoded = worked / count if label == "mean" else float("nan")
        every = [*stages, total - sum(stages), total, encoded]
        rows.append([f"{photo.stem}, {label}", *("" if np.isnan(one) else f"{1000 * one:.1f}" for one in every)])
    return rows, [
        photo.stem,
        f"{size[0]}x{size[1]}",
        str(count),
        f"{count / alone:.0f}",
        f"{count / took:.0f}",
        f"{2 * count / cost:.0f}",
        f"{size_bytes / count / 1000:.1f}",
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pictures", nargs="+", type=Path)
    parser.add_argument("--seconds", type=float, default=8.0)
    asked = parser.parse_args()
    costs, rates = [], []
    with tempfile.TemporaryDirectory() as folder:
        for picture in asked.pictures:
            cost, rate = measure(picture, asked.seconds, Path(folder))
            costs += cost
            rates.append(rate)
    print(machine())
    print(
        table("Processor time, milliseconds a frame", ["frames", *STAGE_FUNCTIONS, "rest", "drawn", "encoded"], costs)
    )
    head = ["picture", "size", "frames", "encoding alone", "all", "two free cores", "kB a frame"]
    print(table("Frames a second", head, rates))


if __name__ == "__main__":
    main()
