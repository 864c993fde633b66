"""Stillness and lag: nothing moves where the driver holds still, and what moves, moves on time and all the way."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.acting import Acting, read_driver, read_target
from benchmarks.shared_media import driving_clips, media, write_clip
from benchmarks.tables import table
from engine.media.image import read_image
from engine.media.video import probe_video, read_video
from engine.perception.faces import FaceTracker
from engine.perception.landmarks import FACE_OVAL, eye_opening, mouth_opening
from engine.portrait.options import PortraitOptions

NOISE = 2.0
"""Standard deviation of the sensor's noise, grey levels: a phone indoors."""
REPEATS = 60
TARGET = "portraits/photo_woman_white.png"
BLINK = 0.6
"""An eye that closes below this share of its usual opening blinks."""


def stillness(names: Sequence[str]) -> None:
    """Print the temporal deviation inside the result's face for one frame repeated with fresh noise."""
    options = PortraitOptions()
    rows = []
    with TemporaryDirectory() as folder:
        rgb = read_image(media(TARGET)).rgb
        target, layers, rig = read_target(Path(folder), rgb, options)
        face = np.zeros(target.rgb.shape[:2], np.uint8)
        cv2.fillPoly(face, [target.mesh[list(FACE_OVAL), :2].round().astype(np.int32)], 1)
        for path in driving_clips(names):
            first = next(iter(read_video(path))).rgb.astype(float)
            rng = np.random.default_rng(0)
            noisy = (
                np.clip(first + rng.normal(0, NOISE, first.shape) + 0.5, 0, 255).astype(np.uint8)
                for _ in range(REPEATS)
            )
            track, neutral = read_driver(write_clip(Path(folder) / "still.mp4", noisy), target, None)
            frames = list(Acting(track, neutral, target, layers, rig, options).frames())
            deviation = np.array(frames, np.float32).std(axis=0).mean(axis=2)[face > 0]
            inner = np.array(frames[10:-10], np.float32).std(axis=0).mean(axis=2)[face > 0]
            jitter = track.meshes[..., :2].std(axis=0).mean()
            figures = (deviation.mean(), np.quantile(deviation, 0.99), inner.mean(), jitter)
            rows.append([path.stem, *(f"{value:.{2 + (k == 3)}f}" for k, value in enumerate(figures))])
    title = f"Stillness: one frame {REPEATS} times, noise of {NOISE:g} levels; deviation inside the face, grey levels"
    print(table(title, ["driver", "mean", "99 %", "without the ends", "mesh, px"], rows))
    print("\nGoal: mean <= 0.5. The target's face is that of the portrait at its own size.")


def lag(names: Sequence[str]) -> None:
    """Print whether lips peak on time and blinks keep their depth, against the unfiltered landmarks."""
    rows = []
    for path in driving_clips(names):
        with TemporaryDirectory() as folder:
            first = next(iter(read_video(path))).rgb
            target = read_target(Path(folder), first, PortraitOptions())[0]
            track, _ = read_driver(path, target, 0)
        with FaceTracker() as tracker:
            found = [tracker(frame.rgb) for frame in read_video(path, longest_side=1280)]
        raw = np.array([meshes[0] if meshes else np.full((478, 3), np.nan) for meshes in found], np.float32)
        lips, kept = mouth_opening(raw), mouth_opening(track.meshes)
        before, after = int(np.nanargmax(lips)), int(kept.argmax())
        depths = _blinks(raw, track.meshes)
        rows.append(
            [path.stem, f"{before}", f"{after}", f"{lips[after] / lips[before]:.3f}", f"{len(depths)}"]
            + ([f"{min(depths):.3f}", f"{np.mean(depths):.3f}"] if depths else ["", ""])
            + [f"{_shift(lips, kept):+d}", f"{probe_video(path).fps:.0f}"]
        )
    head = ["clip", "lips peak", "filtered", "opening there", "blinks", "least depth", "mean", "lag", "fps"]
    print(table("Lag: frames of the widest mouth, and the depth that blinks keep", head, rows))
    print(
        "\nopening there: the unfiltered opening at the filtered peak, against its own peak (1: the same frame or as"
        "\nwide a one). depth: kept by the filter, goal >= 0.95. lag: shift of best correlation, frames."
    )


def _blinks(raw: NDArray[np.float32], kept: NDArray[np.float32]) -> list[float]:
    """Of each blink of the raw track, the share of its depth that the kept one has on that frame or a neighbour."""
    lids, steadied = eye_opening(raw).mean(axis=1), eye_opening(kept).mean(axis=1)
    usual = float(np.nanmedian(lids))
    depths = []
    for i in range(3, len(lids) - 3):
        around = lids[i - 3 : i + 4]
        if lids[i] == np.nanmin(around) and lids[i] < BLINK * usual:
            before = float(np.nanmedian(lids[max(0, i - 12) : max(1, i - 3)]))
            if before - lids[i] > 0.25 * usual:
                depths.append(float((before - steadied[i - 1 : i + 2].min()) / (before - lids[i])))
    return depths


def _shift(a: NDArray[np.floating], b: NDArray[np.floating]) -> int:
    """Frames by which `b` comes after `a`."""
    a = np.nan_to_num(a - np.nanmean(a))
    b = b - b.mean()
    return max(range(-3, 4), key=lambda s: float((a[3:-3] * b[3 + s : len(b) - 3 + s]).sum()))
