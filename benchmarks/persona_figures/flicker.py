"""How still a persona's film is while its driver does little: what changes between frames once motion is taken out, in the film as it is encoded.

The driver waits (the built-in performance `idle`), which breathes, blinks and looks about; or rests: one frame of that, as a camera
films it, with noise. Of each frame and the next the flow is taken out, and the mean absolute change of grey over the face's pixels
told. The same of the driver itself, which was rendered and encoded, is beside it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.presentation.tables import table
from benchmarks.shared_media import media
from engine.errors import InputError
from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.media.video import read_video
from engine.perception.face.faces import FaceTracker
from engine.perception.face.landmarks import FACE_OVAL
from engine.performances import video
from engine.persona.options import PersonaOptions
from engine.persona.pipeline import make_persona
from engine.run import Run
from engine.store import StageStore

FLICKER_DRIVER = "idle"
GOAL_GREY_LEVELS, GOAL_SHARE = 0.3, 0.95
"""Grey levels, in this share of the frames."""
STILL_FRAMES = 75
CAMERA_NOISE_GREY_LEVELS = 2.0
"""Standard deviation, of each channel: a good camera's in a room."""
UNCOUNTED_RIM_PIXELS = 15
"""Pixels of the face's rim that do not count: behind it something else may move."""
FLICKER_FLOW_SIGMA_PIXELS = 6.0


def flicker(names: Sequence[str]) -> None:
    """Print the table."""
    rows = []
    with TemporaryDirectory() as scratch:
        drivers = {"waits": video(FLICKER_DRIVER), "rests": _still(Path(scratch) / "still.mp4")}
        for does, driver in drivers.items():
            rows.append([f"the driver itself {does}", *_told(_changes(driver))])
        for folder in sorted(path for path in media("collections").iterdir() if path.is_dir()):
            if not names or any(name in folder.name for name in names):
                rows += _of_collection(folder, drivers, Path(scratch))
    head = ["film", "median", "95%", f"frames under {GOAL_GREY_LEVELS}"]
    print(
        table(
            f"Change between frames while the driver waits or rests, grey levels; goal {GOAL_GREY_LEVELS} in {GOAL_SHARE:.0%}",
            head,
            rows,
        )
    )


def _of_collection(folder: Path, drivers: Mapping[str, Path], scratch: Path) -> list[list[str]]:
    photos = tuple(sorted(path for path in folder.rglob("*") if path.is_file()))
    rows = []
    for composite in ("none", "photo"):
        options = PersonaOptions.model_validate({"composite": composite})
        for does, driver in drivers.items():
            out = scratch / f"{folder.name}-{composite}-{does}"
            out.mkdir()
            try:
                with Run(StageStore(scratch / "stages")) as run:
                    make_persona({"photos": photos, "driver": driver}, options, out, run)
                told = _told(_changes(out / "animation.mp4"))
            except InputError as error:
                told = [error.code, "", ""]
            rows.append([f"{folder.name}, {composite}, the driver {does}", *told])
    return rows


def _still(path: Path) -> Path:
    """A film of one frame of the driver, whose noise alone changes."""
    rgb = next(iter(read_video(video(FLICKER_DRIVER)))).rgb
    random = np.random.default_rng(0)
    height, width = rgb.shape[:2]
    with VideoWriter(VideoTarget(path, (width, height), 25.0)) as writer:
        for _ in range(STILL_FRAMES):
            noisy = rgb + random.normal(0, CAMERA_NOISE_GREY_LEVELS, rgb.shape)
            writer.write(np.clip(np.rint(noisy), 0, 255).astype(np.uint8))
    return path


def _changes(film: Path) -> NDArray[np.float64]:
    """(F - 1,) mean absolute change of grey over the face, frame by frame."""
    frames = [cv2.cvtColor(frame.rgb, cv2.COLOR_RGB2GRAY) for frame in read_video(film)]
    with FaceTracker(alone=True) as tracker:
        meshes = tracker(next(iter(read_video(film))).rgb)
    face = np.zeros(frames[0].shape, np.uint8)
    cv2.fillPoly(face, [np.rint(meshes[0][list(FACE_OVAL), :2]).astype(np.int32)], 1)
    inner = cv2.erode(face, np.ones((UNCOUNTED_RIM_PIXELS, UNCOUNTED_RIM_PIXELS))) > 0
    flow = cv2.DISOpticalFlow.create(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM)
    rows, columns = np.indices(face.shape, np.float32)
    changes = []
    for before, after in pairwise(frames):
        raw = np.asarray(flow.calc(before, after, np.zeros((*before.shape, 2), np.float32)))
        smooth = np.asarray(cv2.GaussianBlur(raw, (0, 0), FLICKER_FLOW_SIGMA_PIXELS))
        laid = cv2.remap(after.astype(np.float32), columns + smooth[..., 0], rows + smooth[..., 1], cv2.INTER_CUBIC)
        changes.append(float(np.abs(np.asarray(laid) - before)[inner].mean()))
    return np.array(changes)


def _told(changes: NDArray[np.float64]) -> list[str]:
    return [
        f"{np.median(changes):.2f}",
        f"{np.quantile(changes, GOAL_SHARE):.2f}",
        f"{(changes < GOAL_GREY_LEVELS).mean():.0%}",
    ]
