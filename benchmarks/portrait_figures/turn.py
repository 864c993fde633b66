"""Head turns against a scanned head that really turns, and straight lines behind a head that moves."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from benchmarks.known_truth.head_scan import read_head_scan, render_head
from benchmarks.portrait_figures.acting import Acting, read_driver, read_target
from benchmarks.presentation.contact_sheet import Row, contact_sheet, write_sheet
from benchmarks.presentation.tables import table
from benchmarks.shared_media import media, tool, write_clip
from engine.face_animation.warping.layers import Layers
from engine.portrait.options import PortraitOptions

TURNED_PICTURE_SIZE = (480, 576)
HEAD_ZOOM_FACTOR = 1.5
MAX_TURN_DEGREES, SHOWN_DEGREES = 25, (-25, -20, -15, -10, -5, 0, 5, 10, 15, 20, 25)
REST_FRAMES = 6
"""Frames at rest in the beginning: the target and the neutral frame are of them."""
GRID_PITCH_PIXELS = 24
"""Pixels between the lines of the grid on the wall."""
WALL_GREY_LEVEL = 170.0
"""Grey level of the wall."""
LINE_CONTRAST_GREY_LEVELS = 110.0
"""Grey levels by which a line is darker in its middle."""


def turn(pictures: Path | None) -> None:
    """Print how near a portrait, driven by a turning head, comes to the scan that turns so itself."""
    scan = read_head_scan(media("scans3d/head_lee_perry_smith/head.obj").parent)
    angles = (
        [0.0] * REST_FRAMES
        + list(np.linspace(0, -MAX_TURN_DEGREES, 11)[1:])
        + list(np.linspace(-MAX_TURN_DEGREES, MAX_TURN_DEGREES, 21)[1:])
    )
    background = np.repeat(wall(TURNED_PICTURE_SIZE[::-1])[..., None], 3, axis=2).astype(np.uint8)
    rendered = [render_head(scan, angle, TURNED_PICTURE_SIZE, background, HEAD_ZOOM_FACTOR) for angle in angles]
    true = [picture for picture, _ in rendered]
    at = [
        REST_FRAMES - 1 + int(np.abs(np.subtract(angles[REST_FRAMES - 1 :], degrees)).argmin())
        for degrees in SHOWN_DEGREES
    ]
    disguised = tool("disguise").disguise(true, tool("face_measures").Landmarker()(true[0]))
    made = {}
    with TemporaryDirectory() as folder:
        driver = write_clip(Path(folder) / "turn.mp4", disguised)
        for label, head_3d in (("2D", False), ("3D", True)):
            options = PortraitOptions(neutral_frame=0, head_3d=head_3d)
            target, layers, rig = read_target(Path(folder), true[0], options)
            track, neutral = read_driver(driver, target, 0)
            acting = Acting(track, neutral, target, layers, rig, options.acting())
            made[label] = list(acting.frames())
        lines = grid_deviation(acting, rendered[0][1])
    rows = []
    for index, degrees in zip(at, SHOWN_DEGREES, strict=True):
        person = rendered[index][1] > 0.5
        row = [f"{degrees:+d}"]
        for frames in ([true[0]] * len(true), made["2D"], made["3D"]):
            apart = np.abs(true[index].astype(float) - frames[index]).mean(axis=2)[person].mean() / 255
            found = tool("face_measures").compare([true[0], true[index]], [true[0], frames[index]], step=1)
            row += [f"{apart:.4f}", "lost" if found["lost"] else f"{2 * found['akd']:.2f}"]
        rows.append(row)
    head = ["degrees", "still L1", "px", "2D L1", "px", "3D L1", "px"]
    print(
        table("Head turn: a scanned head as target, its disguised turn as driver, against the scan turned", head, rows)
    )
    print("\nL1 in [0, 1] over the true head; px: mean distance of 68 points at 256 px.")
    print(f"Lines of a wall behind the turning head: off by {lines[0]:.2f} px at most outside the person (goal 0.5);")
    print(f"where the head had hidden them {lines[1]:.2f} px at most ({lines[2]:.0%} of those are there).")
    if pictures is not None:
        turns = {"the scan": true, "2D": made["2D"], "3D": made["3D"]}
        rows_shown = [Row([frames[i] for i in at[::2]], title) for title, frames in turns.items()]
        write_sheet(pictures / "turn.png", contact_sheet(rows_shown))


def wall(shape: tuple[int, int]) -> NDArray[np.float64]:
    """(H, W) a bright wall with thin dark lines every `GRID_PITCH_PIXELS` pixels, both ways, their middles at half pixels."""
    y, x = np.mgrid[: shape[0], : shape[1]].astype(float)
    dark = np.zeros(shape)
    for axis in (x, y):
        away = (axis - GRID_PITCH_PIXELS / 2 + 0.5) % GRID_PITCH_PIXELS
        dark = np.maximum(dark, np.exp(-0.5 * np.minimum(away, GRID_PITCH_PIXELS - away) ** 2))
    return np.asarray(WALL_GREY_LEVEL - LINE_CONTRAST_GREY_LEVELS * dark)


def grid_deviation(acting: Acting, covered: NDArray[np.float32]) -> tuple[float, float, float]:
    """Largest deviation of the wall's lines outside the person, pixels; the same where the person at rest
    (`covered`, the truth) had hidden them, of those that are there; and how many are."""
    plates = [np.full_like(acting.layers.plate, level) for level in (0, 255)]
    low, high = (replace(acting, layers=Layers(acting.layers.person, plate)) for plate in plates)
    outside: list[float] = [0.0]
    hidden: list[float] = []
    for frame, black, white in zip(acting.frames(step=3), low.frames(step=3), high.frames(step=3), strict=True):
        clear = (white.astype(float) - black).mean(axis=2) > 252
        for turned in (False, True):
            pixels = frame.transpose(1, 0, 2) if turned else frame
            seen, rest = (clear.T, covered.T) if turned else (clear, covered)
            outside += _line_errors(pixels, seen & (rest < 0.01)).tolist()
            hidden += _line_errors(pixels, seen & (rest > 0.5)).tolist()
    there = [e for e in hidden if np.isfinite(e)]
    return max(outside), max(there, default=0.0), len(there) / max(len(hidden), 1)


def _line_errors(frame: NDArray[np.uint8], visible: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Pixels by which the horizontal lines are off, between crossings; infinite where there is none."""
    grey = frame.astype(float).mean(axis=2)
    columns = np.arange(frame.shape[1])
    between = (
        np.abs((columns - GRID_PITCH_PIXELS / 2 + 0.5) % GRID_PITCH_PIXELS - GRID_PITCH_PIXELS / 2)
        < GRID_PITCH_PIXELS / 2 - 6
    )
    errors = []
    for y in np.arange(GRID_PITCH_PIXELS / 2 - 0.5, frame.shape[0] - 8, GRID_PITCH_PIXELS):
        rows = np.arange(round(y - 5.5), round(y + 6.5))
        if rows[0] < 0:
            continue
        chosen = between & visible[rows].all(axis=0)
        dark = np.clip(WALL_GREY_LEVEL - 12 - grey[rows][:, chosen], 0, None)
        total = dark.sum(axis=0)
        found = (rows[:, None] * dark).sum(axis=0) / np.maximum(total, 1e-6)
        errors.append(np.where(total > 60, np.abs(found - y), np.inf))
    return np.concatenate(errors) if errors else np.zeros(0)
