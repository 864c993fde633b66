"""Stillness and lag: nothing moves where the driver holds still, and what moves, moves on time and all the way."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.portrait_figures.acting import Acting, read_driver, read_target
from benchmarks.presentation.tables import table
from benchmarks.shared_media import driving_clips, media, write_clip
from engine.media.image import read_image
from engine.media.video import probe_video, read_video
from engine.perception.face.faces import FaceTracker
from engine.perception.face.landmarks import FACE_OVAL, MESH_SIZE, eye_opening, mouth_opening
from engine.portrait.options import PortraitOptions

SENSOR_SIGMA_GREY_LEVELS = 2.0
"""Standard deviation of the sensor's noise, grey levels: a phone indoors."""
STILL_FRAMES = 60
"""Frames of the still driver."""
STEADY_TARGET = "portraits/photo_woman_white.png"
USUAL_OPENING_BLINK_SHARE = 0.6
"""Share of its usual opening below which an eye blinks."""
MIN_BLINK_DEPTH_SHARE = 0.95
"""Share of its depth that a blink is to keep, at least."""


def stillness(names: Sequence[str]) -> None:
    """Print the temporal deviation inside the result's face for one frame repeated with fresh noise."""
    options = PortraitOptions()
    rows = []
    with TemporaryDirectory() as folder:
        rgb = read_image(media(STEADY_TARGET)).rgb
        target, layers, rig = read_target(Path(folder), rgb, options)
        face = np.zeros(target.rgb.shape[:2], np.uint8)
        cv2.fillPoly(face, [target.mesh[list(FACE_OVAL), :2].round().astype(np.int32)], 1)
        for path in driving_clips(names):
            first = next(iter(read_video(path))).rgb.astype(float)
            rng = np.random.default_rng(0)
            noisy = (
                np.clip(first + rng.normal(0, SENSOR_SIGMA_GREY_LEVELS, first.shape) + 0.5, 0, 255).astype(np.uint8)
                for _ in range(STILL_FRAMES)
            )
            track, neutral = read_driver(write_clip(Path(folder) / "still.mp4", noisy), target, None)
            frames = list(Acting(track, neutral, target, layers, rig, options.acting()).frames())
            deviation = np.array(frames, np.float32).std(axis=0).mean(axis=2)[face > 0]
            inner = np.array(frames[10:-10], np.float32).std(axis=0).mean(axis=2)[face > 0]
            jitter = track.meshes[..., :2].std(axis=0).mean()
            figures = (deviation.mean(), np.quantile(deviation, 0.99), inner.mean(), jitter)
            rows.append([path.stem, *(f"{value:.{2 + (k == 3)}f}" for k, value in enumerate(figures))])
    title = f"Stillness: one frame {STILL_FRAMES} times, noise of {SENSOR_SIGMA_GREY_LEVELS:g} levels; deviation inside the face, grey levels"
    print(table(title, ["driver", "mean", "99 %", "without the ends", "mesh, px"], rows))
    print("\nGoal: mean <= 0.5. The target's face is that of the portrait at its own size.")


def lag(names: Sequence[str]) -> None:
    """Print whether lips peak on time and blinks keep their depth, in the driver's track and in the result's face, against
    the unfiltered landmarks of the driver."""
    lips: list[list[str]] = []
    lids: list[list[str]] = []
    every: dict[str, list[Blink]] = {"track": [], "result": []}
    for path in driving_clips(names):
        raw, track, made = _followed(path)
        opening = mouth_opening(raw)
        lips.append([path.stem, f"{probe_video(path).fps:.0f}", f"{np.nanargmax(opening)}", f"{np.nanmax(opening):.2f}"])  # fmt: skip
        lids.append([path.stem, f"{len(blinks(raw, track))}"])
        for of, kept in (("track", track), ("result", made)):
            peak = int(np.nanargmax(mouth_opening(kept)))
            there = opening[peak] / np.nanmax(opening)
            lips[-1] += [f"{peak}", f"{there:.3f}", f"{_shift(opening, mouth_opening(kept)):+d}"]
            found = blinks(raw, kept)
            for values in ([one.depth for one in found], [one.shut for one in found]):
                lids[-1] += [f"{min(values):.3f}", f"{np.mean(values):.3f}"] if found else ["", ""]
            every[of] += found
    of_peaks = [head for of in every for head in (f"{of}'s", "opening there", "lag")]
    print(table("Lag: the frame of the widest mouth", ["clip", "fps", "driver's", "gap", *of_peaks], lips))
    print(
        "\nThe clip's first frame, driven by the clip. gap: between the driver's lips at their peak, in widths of the mouth;"
        "\nfrom 0.05 they are parted. opening there: the driver's gap at that peak, against its own peak (1: the same frame or"
        "\nas wide a one). lag: shift of best correlation, frames."
    )
    of_blinks = [f"{of}: {what}" for of in every for what in ("least depth", "mean", "least shut", "mean")]
    print(table("Blinks: what is kept of the unfiltered landmarks'", ["clip", "blinks", *of_blinks], lids))
    print("\ndepth: from the eye's own opening before. shut: from the driver's opening before.")
    for of, found in every.items():
        deep, shut = (
            sum(one.depth >= MIN_BLINK_DEPTH_SHARE for one in found),
            sum(one.shut >= MIN_BLINK_DEPTH_SHARE for one in found),
        )
        print(
            f"{of}: of {len(found)} blinks {deep} keep {100 * MIN_BLINK_DEPTH_SHARE:.0f}% of their depth (goal: all), {shut} shut so far"
        )


def _followed(path: Path) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]:
    """Meshes (N, 478, 3) of a clip: unfiltered; as they drive; and as they are seen on its first frame driven by it."""
    with TemporaryDirectory() as folder:
        options = PortraitOptions(neutral_frame=0)
        target, layers, rig = read_target(Path(folder), next(iter(read_video(path))).rgb, options)
        track, neutral = read_driver(path, target, 0)
        made = _looked_at(Acting(track, neutral, target, layers, rig, options.acting()).frames())
    return _looked_at(frame.rgb for frame in read_video(path, longest_side=1280)), track.meshes, made


class Blink(NamedTuple):
    """The share of a blink's depth that is kept, and how far the eye shuts, as a share of the way from open to shut."""

    depth: float
    shut: float


def _looked_at(frames: Iterable[NDArray[np.uint8]]) -> NDArray[np.float32]:
    """(N, 478, 3) what the tracker sees, unfiltered; NaN where it sees no face."""
    with FaceTracker() as tracker:
        found = [tracker(frame) for frame in frames]
    return np.array([meshes[0] if meshes else np.full((MESH_SIZE, 3), np.nan) for meshes in found], np.float32)


def blinks(raw: NDArray[np.float32], kept: NDArray[np.float32]) -> list[Blink]:
    """What the kept meshes (N, 478, 3) have of each blink of the raw ones, on its frame or one beside."""
    lids, own = eye_opening(raw).mean(axis=1), eye_opening(kept).mean(axis=1)
    usual = float(np.nanmedian(lids))
    found = []
    for i in range(3, len(lids) - 3):
        if lids[i] == np.nanmin(lids[i - 3 : i + 4]) and lids[i] < USUAL_OPENING_BLINK_SHARE * usual:
            before = slice(max(0, i - 12), max(1, i - 3))
            opened = float(np.nanmedian(lids[before]))
            depth = opened - float(lids[i])
            if depth > 0.25 * usual:
                least = float(np.nanmin(own[i - 1 : i + 2]))
                found.append(Blink((float(np.nanmedian(own[before])) - least) / depth, (opened - least) / depth))
    return found


def _shift(a: NDArray[np.floating], b: NDArray[np.floating]) -> int:
    """Frames by which `b` comes after `a`."""
    a, b = (np.nan_to_num(opened - np.nanmean(opened)) for opened in (a, b))
    return max(range(-3, 4), key=lambda s: float((a[3:-3] * b[3 + s : len(b) - 3 + s]).sum()))
