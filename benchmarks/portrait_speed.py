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

from benchmarks.shared_media import ROOT, media
from benchmarks.tables import table
from engine.export.video import VideoWriter
from engine.media.image import read_image, write_image
from engine.media.video import probe_video, read_video
from engine.portrait.options import PortraitOptions
from engine.portrait.pipeline import STAGES, animate_portrait
from engine.run import Run
from engine.store import StageStore

SIZE, FRAMES = (600, 800), 100
PORTRAIT, CLIP = "portraits/photo_man_suit.png", "driving/man_mouth_open_d18.mp4"
GOAL, PAPER = 3.3, 42.0


def speed(repeats: int, frames: int) -> None:
    """Print both tables; each figure is the median of `repeats`."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        image, clip = portrait(folder), _clip(folder, frames)
        _warm(image, clip, folder, repeats, frames)
        _processes(image, clip, folder, repeats, frames)


def portrait(folder: Path) -> Path:
    """A portrait of exactly `SIZE`."""
    rgb = read_image(media(PORTRAIT)).rgb
    height = round(rgb.shape[1] * SIZE[1] / SIZE[0])
    path = folder / "portrait.png"
    write_image(path, np.asarray(cv2.resize(rgb[:height], SIZE, interpolation=cv2.INTER_AREA)))
    return path


def _clip(folder: Path, frames: int) -> Path:
    """The first frames of a driving clip, at its own size and rate, as a phone would have compressed it."""
    source = media(CLIP)
    info = probe_video(source)
    first = [frame.rgb for frame, _ in zip(read_video(source), range(frames), strict=False)]
    path = folder / "driver.mp4"
    with VideoWriter(path, (info.width, info.height), info.fps) as writer:
        for rgb in first:
            writer.write(rgb)
    return path


def _warm(image: Path, clip: Path, folder: Path, repeats: int, frames: int) -> None:
    def run(target: StageStore, driver: StageStore, clip: Path = clip) -> tuple[Run, float]:
        out = folder / "out"
        out.mkdir(exist_ok=True)
        one = Run(store=target, shared=driver)
        started = time.perf_counter()
        animate_portrait({"image": image, "driver": clip}, PortraitOptions(), out, one)
        return one, time.perf_counter() - started

    known = StageStore(folder / "target"), StageStore(folder / "driver")
    run(*known)  # loads the models, compiles, and fills the stores
    fresh = iter(range(10**6))

    def new() -> StageStore:
        return StageStore(folder / f"new{next(fresh)}")

    (folder / "other").mkdir()
    met = new()
    run(met, new(), _clip(folder / "other", 10))

    def another() -> StageStore:
        """One that knows the target by another driver alone."""
        store = new()
        shutil.copytree(met.folder, store.folder)
        return store

    cases: list[tuple[str, Callable[[], tuple[Run, float]]]] = [
        ("target and driver known", lambda: run(*known)),
        ("target known, driver new", lambda: run(another(), new())),
        ("both new", lambda: run(new(), new())),
    ]
    rows = []
    for label, case in cases:
        runs = [case() for _ in range(repeats)]
        per_stage = [statistics.median(one.seconds.get(stage, 0.0) for one, _ in runs) for stage in STAGES]
        total = statistics.median(seconds for _, seconds in runs)
        rows.append([label, *(f"{s:.2f}" for s in per_stage), f"{total:.2f}", f"{frames / total:.0f}"])
    title = f"Speed, warm process: {frames} frames at {SIZE[0]}x{SIZE[1]}, encoding included, seconds"
    print(table(title, ["", *STAGES, "all", "frames/s"], rows))
    print(f"\nGoal for the first row: {GOAL * frames / 100:.1f} s; the paper: {PAPER * frames / 100:.0f} s.")


def _processes(image: Path, clip: Path, folder: Path, repeats: int, frames: int) -> None:
    def galatea(data: Path, image: Path = image) -> float:
        command = [sys.executable, "-m", "shell.main", "portrait", str(image), "--driver", str(clip)]
        return _timed([*command, "-o", str(folder / "shell")], {"GALATEA_DATA_DIR": str(data)})

    def lowest() -> float:
        return _timed([sys.executable, "-m", "benchmarks.floor", str(clip), str(folder / "floor.mp4")], {})

    lowest()  # fills the caches of files and of compiled code
    galatea(folder / "known")
    cases: dict[str, tuple[str, Callable[[int], float]]] = {
        "the floor: decode, face tracking, H.264": ("", lambda k: lowest()),
        "galatea portrait, driver seen for the first time": ("2", lambda k: galatea(folder / f"unknown{k}")),
        "galatea portrait, driver analysed, a new portrait": (
            "1",
            lambda k: galatea(folder / "known", _another(image, k)),
        ),
        "galatea portrait, driver and portrait analysed": ("1", lambda k: galatea(folder / "known")),
    }
    # in turn, so that all meet the machine in the same moods
    seconds = np.array([[case(k) for _, case in cases.values()] for k in range(repeats)])
    rows = [
        [label, f"{own:.2f}", f"{ratio:.2f}", goal]
        for (label, (goal, _)), own, ratio in zip(
            cases.items(), np.median(seconds, axis=0), np.median(seconds / seconds[:, :1], axis=0), strict=True
        )
    ]
    print(table(f"Speed, whole processes: the same {frames} frames", ["", "seconds", "to the floor", "goal"], rows))


def _another(image: Path, number: int) -> Path:
    """The same portrait as far as the eye can tell, and another one by its content."""
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
