"""How long a persona takes: to be made, for each photo, stage by stage; its textures; its films, the driver analysed."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.presentation.tables import table
from benchmarks.shared_media import media
from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.media.image import read_image
from engine.media.video import read_video
from engine.perception.face.faces import FaceTracker
from engine.performances import video
from engine.persona.options import PersonaOptions
from engine.persona.persona import Persona, read_persona
from engine.persona.pipeline import LEARNING_STAGES, make_persona
from engine.persona.texture.synthesis import texture_synthesis
from engine.run import Run
from engine.store import StageStore

SPEED_DRIVER = "happy-strong"
FILM_SIZE = (600, 800)
TEXTURE_SIZES_AND_FPS = (((244, 194), 200), ((500, 400), 40))
"""Height and width, and the frames a second that are aimed at."""
FPS_GOALS = {"puppet alone": 30.0, "photo": 20.0}
SECONDS_PER_PHOTO = 0.6
"""That are aimed at."""
MAKING_STAGES = (*LEARNING_STAGES, "write_persona", "write_results")
FRAMES_PER_BATCH = 32


def speed(names: Sequence[str], photos: int | None, repeats: int) -> None:
    """Print the tables."""
    found = [folder for folder in sorted(media("collections").iterdir()) if folder.is_dir()]
    chosen = [folder for folder in found if not names or any(name in folder.name for name in names)]
    making, textures, films = [], [], []
    for folder in chosen:
        paths = sorted(path for path in folder.rglob("*") if path.suffix in (".jpg", ".jpeg", ".png"))[:photos]
        with TemporaryDirectory() as scratch:
            made, persona = _made(tuple(paths), Path(scratch))
            making.append([f"{folder.name}, {len(paths)}", *made])
            textures += [[folder.name, *row] for row in _textures(persona, repeats)]
            films += [[folder.name, *row] for row in _films(Path(scratch), repeats)]
    head = ["photos", *MAKING_STAGES, "all", "plain face mesh", "to it"]
    print(table(f"Making, seconds for each photo; goal {SECONDS_PER_PHOTO}", head, making))
    head = ["photos", "size", "used", "one by one", f"in batches of {FRAMES_PER_BATCH}", "goal", "to copying"]
    print(table("Textures, frames a second", head, textures))
    head = ["photos", "film", "frames/s", "goal", "to encoding alone"]
    print(table(f"Films at {FILM_SIZE[0]}x{FILM_SIZE[1]}, driver analysed, encoding included", head, films))


def _made(paths: tuple[Path, ...], scratch: Path) -> tuple[list[str], Persona]:
    with Run(StageStore(scratch / "made")) as run:
        make_persona({"photos": paths}, PersonaOptions(), scratch, run)
    each = [run.seconds.get(stage, 0.0) / len(paths) for stage in MAKING_STAGES]
    sample = [read_image(path).rgb for path in paths[:: max(len(paths) // 20, 1)]]
    with FaceTracker(alone=True) as tracker:
        tracker(sample[0])
        floor = _seconds(lambda: [tracker(photo) for photo in sample]) / len(sample)
    numbers = [*each, sum(each), floor]
    return [*(f"{one:.3f}" for one in numbers), f"{sum(each) / floor:.1f}"], read_persona(scratch / "persona.npz")


def _textures(persona: Persona, repeats: int) -> list[list[str]]:
    rows = []
    for (height, width), goal in TEXTURE_SIZES_AND_FPS:
        colours = np.array([cv2.resize(one, (width, height)) for one in persona.colours])
        belief = np.array([cv2.resize(one, (width, height)) for one in persona.belief], np.float32) / np.float32(255)
        alone, together, copied = _texture_rates(colours, belief, repeats)
        size = f"{width}x{height}"
        rows.append([size, str(len(persona)), f"{alone:.0f}", f"{together:.0f}", str(goal), f"{copied / together:.1f}"])
    return rows


def _texture_rates(colours: NDArray[np.uint8], belief: NDArray[np.float32], repeats: int) -> tuple[float, float, float]:
    """Textures a second: one by one, in batches, and as fast as one photo is copied to floating point and back."""
    synthesis = texture_synthesis(colours, belief)
    weights = np.random.default_rng(0).random((FRAMES_PER_BATCH, len(colours)), np.float32)

    def alone() -> None:
        for one in weights:
            synthesis(one[None])

    def together() -> None:
        synthesis(weights)

    def copied() -> None:
        for number in range(FRAMES_PER_BATCH):
            colours[number % len(colours)].astype(np.float32).astype(np.uint8)

    alone()
    rates = [
        FRAMES_PER_BATCH / statistics.median(_seconds(work) for _ in range(repeats))
        for work in (alone, together, copied)
    ]
    return rates[0], rates[1], rates[2]


def _films(scratch: Path, repeats: int) -> list[list[str]]:
    store, out = StageStore(scratch / "driven"), scratch / "film"
    out.mkdir()
    inputs = {"persona": scratch / "persona.npz", "driver": video(SPEED_DRIVER)}
    rows = []
    for name, composite in (("puppet alone", "none"), ("photo", "photo")):
        options = PersonaOptions.model_validate({"size": FILM_SIZE, "composite": composite})

        def once(options: PersonaOptions = options) -> Run:
            with Run(store) as run:
                make_persona(inputs, options, out, run)
            return run

        once()  # analyses the driver, compiles, and fills the store
        seconds = [_driven(once()) for _ in range(repeats)]
        frames = [frame.rgb for frame in read_video(out / "animation.mp4")]
        floor = statistics.median(_encoded(frames, out / "floor.mp4") for _ in range(repeats))
        took = statistics.median(seconds)
        rate = len(frames) / took
        rows.append([name, f"{rate:.0f}", f"{FPS_GOALS[name]:.0f}", f"{took / floor:.1f}"])
    return rows


def _driven(run: Run) -> float:
    """Seconds of all stages but for those that read and write the persona itself."""
    return sum(seconds for stage, seconds in run.seconds.items() if stage not in MAKING_STAGES)


def _encoded(frames: list[NDArray[np.uint8]], path: Path) -> float:
    def write() -> None:
        height, width = frames[0].shape[:2]
        with VideoWriter(VideoTarget(path, (width, height), 25.0)) as writer:
            for frame in frames:
                writer.write(frame)

    return _seconds(write)


def _seconds(work: Callable[[], object]) -> float:
    started = time.perf_counter()
    work()
    return time.perf_counter() - started
