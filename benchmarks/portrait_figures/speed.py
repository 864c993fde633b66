"""How long an animation takes: stage by stage in a warm process, and as whole processes against the floor."""

from __future__ import annotations

import os
import shutil
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.presentation.tables import table
from benchmarks.shared_media import ROOT, media
from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.media.image import read_image, write_image
from engine.media.video import probe_video, read_video
from engine.portrait.options import PortraitOptions
from engine.portrait.pipeline import STAGES, animate_portrait
from engine.run import Run
from engine.store import StageStore

TIMED_PICTURE_SIZE, CLIP_FRAMES = (600, 800), 100
TIMED_PORTRAIT = "portraits/photo_man_suit.png"
SMALL_CLIP, PHONE_CLIP = "driving/man_mouth_open_d18.mp4", "driving/man_selfie_talk_d13.mp4"
"""A small clip, as drivers are passed around (480x480), and a phone's, cut and reduced to the portrait's own size."""
GOAL_SECONDS = 3.3
"""Seconds for 100 frames that are aimed at."""
PAPER_SECONDS = 42.0
"""Seconds for 100 frames that the paper tells."""


def speed(repeats: int, frames: int) -> None:
    """Print both tables; each figure is the median of `repeats`."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        image, clip = portrait(folder), _clip(folder, frames)
        _warm(image, clip, folder, repeats, frames)
        for name in (SMALL_CLIP, PHONE_CLIP):
            place = folder / Path(name).stem
            place.mkdir()
            _processes(image, _clip(place, frames, name), place, repeats, frames)


def portrait(folder: Path) -> Path:
    """A portrait of exactly `TIMED_PICTURE_SIZE`."""
    rgb = read_image(media(TIMED_PORTRAIT)).rgb
    height = round(rgb.shape[1] * TIMED_PICTURE_SIZE[1] / TIMED_PICTURE_SIZE[0])
    path = folder / "portrait.png"
    write_image(path, np.asarray(cv2.resize(rgb[:height], TIMED_PICTURE_SIZE, interpolation=cv2.INTER_AREA)))
    return path


def _clip(folder: Path, frames: int, name: str = SMALL_CLIP) -> Path:
    """The first frames of a driving clip, at its own rate, as a phone would have compressed it; an upright one cut and
    reduced to `TIMED_PICTURE_SIZE`, others at their own size."""
    source = media(name)
    info = probe_video(source)
    upright = info.height > info.width
    path = folder / "driver.mp4"
    with VideoWriter(
        VideoTarget(path, TIMED_PICTURE_SIZE if upright else (info.width, info.height), info.fps)
    ) as writer:
        for frame, _ in zip(read_video(source), range(frames), strict=False):
            writer.write(_cut(frame.rgb) if upright else frame.rgb)
    return path


def _cut(rgb: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The middle of a taller picture, at `TIMED_PICTURE_SIZE`."""
    height = round(rgb.shape[1] * TIMED_PICTURE_SIZE[1] / TIMED_PICTURE_SIZE[0])
    top = (rgb.shape[0] - height) // 2
    return np.asarray(cv2.resize(rgb[top : top + height], TIMED_PICTURE_SIZE, interpolation=cv2.INTER_AREA), np.uint8)


def _warm(image: Path, clip: Path, folder: Path, repeats: int, frames: int) -> None:
    def run(target: StageStore, driver: StageStore, clip: Path = clip) -> tuple[Run, float]:
        out = folder / "out"
        out.mkdir(exist_ok=True)
        started = time.perf_counter()
        with Run(store=target, shared=driver) as one:
            animate_portrait({"image": image, "driver": clip}, PortraitOptions(), out, one)
        return one, time.perf_counter() - started

    known = StageStore(folder / "target"), StageStore(folder / "driver")
    run(*known)  # loads the models, compiles, and fills the stores
    fresh = iter(range(10**6))

    def new() -> StageStore:
        return StageStore(folder / f"new{next(fresh)}")

    other = folder / "other"
    other.mkdir()
    met, followed = new(), new()
    run(met, new(), _clip(other, 10))
    run(new(), followed)

    def like(known: StageStore) -> StageStore:
        store = new()
        shutil.copytree(known.folder, store.folder)
        return store

    cases: list[tuple[str, Callable[[], tuple[Run, float]]]] = [
        ("target and driver known", lambda: run(*known)),
        ("driver known, target new", lambda: run(new(), like(followed))),
        ("target known, driver new", lambda: run(like(met), new())),
        ("both new", lambda: run(new(), new())),
    ]
    rows = []
    for label, case in cases:
        runs = [case() for _ in range(repeats)]
        per_stage = [statistics.median(one.seconds.get(stage, 0.0) for one, _ in runs) for stage in STAGES]
        total = statistics.median(seconds for _, seconds in runs)
        rows.append([label, *(f"{s:.2f}" for s in per_stage), f"{total:.2f}", f"{frames / total:.0f}"])
    title = f"Speed, warm process: {frames} frames at {TIMED_PICTURE_SIZE[0]}x{TIMED_PICTURE_SIZE[1]}, encoding included, seconds"
    print(table(title, ["", *STAGES, "all", "frames/s"], rows))
    print(
        f"\nGoal for the first row: {GOAL_SECONDS * frames / 100:.1f} s; the paper: {PAPER_SECONDS * frames / 100:.0f} s."
    )


def _processes(image: Path, clip: Path, folder: Path, repeats: int, frames: int) -> None:
    def galatea(data: Path, image: Path = image) -> float:
        command = [sys.executable, "-m", "shell.main", "portrait", str(image), "--driver", str(clip)]
        return _timed([*command, "-o", str(folder / "shell")], {"GALATEA_DATA_DIR": str(data)})

    def alone(program: str) -> float:
        return _timed([sys.executable, "-m", f"benchmarks.{program}", str(clip), str(folder / "floor.mp4")], {})

    alone("plain_script")  # fills the caches of files and of compiled code
    alone("floor")
    galatea(folder / "known")
    cases: dict[str, tuple[str, Callable[[int], float]]] = {
        "decode, face tracking, H.264 by a plain script": ("", lambda k: alone("plain_script")),
        "the same by this project's parts alone": ("", lambda k: alone("floor")),
        "galatea portrait, driver seen for the first time": ("2", lambda k: galatea(folder / f"unknown{k}")),
        "galatea portrait, driver analysed, a new portrait": (
            "1",
            lambda k: galatea(folder / "known", _another(image, k)),
        ),
        "galatea portrait, driver and portrait analysed": ("1", lambda k: galatea(folder / "known")),
    }
    # in turn, so that all meet the machine in the same moods
    seconds = np.array([[case(k) for _, case in cases.values()] for k in range(repeats)])
    middle = [np.median(each, axis=0) for each in (seconds, seconds / seconds[:, :1], seconds / seconds[:, 1:2])]
    rows = [
        [label, f"{own:.2f}", f"{plain:.2f}", f"{lean:.2f}", goal]
        for (label, (goal, _)), own, plain, lean in zip(cases.items(), *middle, strict=True)
    ]
    info = probe_video(clip)
    title = f"Speed, whole processes: {frames} frames, the driver's {info.width}x{info.height}"
    print(table(title, ["", "seconds", "to the plain script", "to the lean one", "goal"], rows))


def _another(image: Path, number: int) -> Path:
    """A copy of a portrait that no eye tells from it, though its bytes differ."""
    rgb = read_image(image).rgb.copy()
    rgb[0, 0] = number
    path = image.with_name(f"another{number}.png")
    write_image(path, rgb)
    return path


def _timed(command: list[str], environment: dict[str, str]) -> float:
    started = time.perf_counter()
    done = subprocess.run(
        command, cwd=ROOT, env={**os.environ, **environment}, capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise SystemExit(f"{' '.join(command)}\n{done.stderr[-2000:]}")
    return time.perf_counter() - started
