"""Mouths and eyes: whether what a lively driver uncovers is of the target's palette, and changes as the driver's does."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.portrait_figures.acting import Acting, read_driver, read_target
from benchmarks.presentation.tables import table
from benchmarks.shared_media import driving_clips, media
from engine.face_animation.animation import FaceAnimation, RegisteredDriver, RiggedTarget, draw_in_order
from engine.face_animation.creases.fine_details import RatioStrip
from engine.face_animation.eyes.gaze import iris_positions
from engine.face_animation.mouth.lip_contours import LOWER_INNER_LIP, UPPER_INNER_LIP
from engine.face_animation.skin_colour import skin_colour
from engine.media.image import read_image
from engine.perception.face.landmarks import (
    LEFT_EYE,
    LEFT_IRIS,
    LIPS_INNER,
    LIPS_OUTER,
    RIGHT_EYE,
    RIGHT_IRIS,
    mouth_opening,
)
from engine.portrait.options import PortraitOptions

WATCHED_TARGETS = (
    *("photo_trump_smile.png", "pair2_neutral.png", "painting_child.jpg", "painting_la_velata.jpg"),
    *("photo_diana.jpg", "pair2_smile.png"),
)
WATCHED_CLIPS = ("woman_wow_d10", "man_laugh_d12")
WATCHED_SIZE_PIXELS, FILM_FPS = (480, 480), 12.5
MIN_OPEN_MOUTH_OPENING = 0.12
"""Of a mouth, from which on its inside is looked at."""
ROW_COUNT, SPARED_ROW_COUNT = 12, 2
"""Places from lip to lip, and how many of them at either lip are not looked at, for they are as much the lip's."""
HUE_TOLERANCE_GREY_LEVELS = 6.0
"""Grey levels by which a channel may lie above what the palette allows: of noise and of JPEG."""
SIDE_GLANCE_EYE_WIDTHS = 0.06
"""Eye widths of gaze from which on a glance is aside."""
WHITE_SHARE = 0.6
"""Of the light of the skin around the mouth, from which on a pixel beside the iris counts as white."""


def mouths_and_eyes(names: Sequence[str]) -> None:
    """Print what of mouths is out of the target's palette, how they change against the driver's, and what of eyes' whites is white."""
    rows = []
    options = PortraitOptions(crop="bust", size=WATCHED_SIZE_PIXELS, fps=FILM_FPS)
    for clip in driving_clips(list(names) or WATCHED_CLIPS):
        for name in WATCHED_TARGETS:
            with TemporaryDirectory() as folder:
                rgb = read_image(media(f"portraits/{name}")).rgb
                target, layers, rig = read_target(Path(folder), rgb, options)
                track, neutral = read_driver(clip, target, None)
                acting = Acting(track, neutral, target, layers, rig, options.acting(), looked=False)
                rows.append([clip.stem, Path(name).stem, *(f"{value:.2f}" for value in of_acting(acting))])
    head = ["driver", "target", "out of palette", "change / driver's", "white of whites"]
    print(table("Mouths and eyes that a lively driver uncovers", head, rows))
    print(
        "\nout of palette: share of an open mouth that is bluer or greener than grey and the target's skin and lips. change / driver's: from frame to frame"
        "\nwithin the lips, against the same in the driver. white of whites: share of what lies beside the irises in side glances that is light."
    )


def of_acting(acting: Acting) -> tuple[float, float, float]:
    """The three figures of an acting; creases do not count."""
    animation = FaceAnimation(
        RiggedTarget(acting.target, acting.layers, acting.rig),
        RegisteredDriver(acting.track, acting.neutral),
        acting.options,
    )
    motions = list(animation.motions())
    faces = [animation.face(motion) for motion in motions]
    frames = draw_in_order(animation.draw, zip(motions, RatioStrip(), strict=False))
    palette = palette_of(acting.target.rgb, acting.target.mesh)
    made, own, misfits, whites = [], [], [], []
    glances = np.abs(iris_positions(acting.track.meshes) - iris_positions(acting.track.meshes[[acting.neutral]]))
    for number, (frame, face) in enumerate(zip(frames, faces, strict=True)):
        open_mouth = float(mouth_opening(face)) > MIN_OPEN_MOUTH_OPENING
        within = between_lips(frame, face)
        made.append(within if open_mouth else None)
        own.append(between_lips(acting.track.crop(number), acting.track.in_crop(number)) if open_mouth else None)
        if open_mouth:
            misfits.append(out_of_palette(within, palette))
        if glances[number, :, 0].max() > SIDE_GLANCE_EYE_WIDTHS:
            whites += white_shares(frame, face, float(palette[0].mean()))
    ratio = change(made) / max(change(own), 1e-6)
    return float(np.mean(misfits or [0])), ratio, float(np.mean(whites or [0]))


def between_lips(rgb: NDArray[np.uint8], face: NDArray[np.floating]) -> NDArray[np.float32]:
    """(ROW_COUNT - 2 SPARED_ROW_COUNT, 9, 3) colours between the inner lips of a face (478, 2), from lip to lip and corner to corner."""
    upper, lower = (face[list(lip[1:-1]), :2] for lip in (UPPER_INNER_LIP, LOWER_INNER_LIP))
    down = ((np.arange(ROW_COUNT) + 0.5) / ROW_COUNT)[SPARED_ROW_COUNT : ROW_COUNT - SPARED_ROW_COUNT, None, None]
    at = (upper + down * (lower - upper)).astype(np.float32)
    return np.asarray(
        cv2.remap(rgb, at[..., 0], at[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE), np.float32
    )


def out_of_palette(colours: NDArray[np.floating], palette: NDArray[np.floating]) -> float:
    """The share of colours (..., 3) that are bluer beside their green, or greener beside their red, than all of a `palette` (P, 3)."""
    bluest, greenest = (max(1.0, float((palette[:, k] / np.maximum(palette[:, k - 1], 1)).max())) for k in (2, 1))
    off = colours[..., 2] > bluest * colours[..., 1] + HUE_TOLERANCE_GREY_LEVELS
    return float((off | (colours[..., 1] > greenest * colours[..., 0] + HUE_TOLERANCE_GREY_LEVELS)).mean())


def palette_of(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> NDArray[np.float64]:
    """(2, 3) the colours of a face's skin and lips."""
    lips = np.zeros(rgb.shape[:2], np.uint8)
    cv2.fillPoly(lips, [np.rint(mesh[list(LIPS_OUTER), :2]).astype(np.int32)], 1)
    cv2.fillPoly(lips, [np.rint(mesh[list(LIPS_INNER), :2]).astype(np.int32)], 0)
    return np.array([skin_colour(rgb, mesh), cv2.mean(rgb, lips)[:3]])


def change(mouths: Sequence[NDArray[np.floating] | None]) -> float:
    """The mean change from each frame to the next where both have an open mouth, of its own mean light."""
    pairs = [(a, b) for a, b in pairwise(mouths) if a is not None and b is not None]
    return float(np.mean([np.abs(b - a).mean() / max(float(a.mean()), 8.0) for a, b in pairs])) if pairs else 0.0


def white_shares(rgb: NDArray[np.uint8], face: NDArray[np.floating], skin: float) -> list[float]:
    """Of each eye that is open, the share of what lies within its lids and beside its iris that is lighter than `WHITE_SHARE` of the `skin`."""
    found = []
    for contour, iris in ((RIGHT_EYE, RIGHT_IRIS), (LEFT_EYE, LEFT_IRIS)):
        mask = np.zeros(rgb.shape[:2], np.uint8)
        cv2.fillPoly(mask, [np.rint(face[list(contour), :2]).astype(np.int32)], 1)
        mask = np.asarray(cv2.erode(mask, np.ones((3, 3), np.uint8)))
        radius = float(np.linalg.norm(face[list(iris[1:]), :2] - face[iris[0], :2], axis=1).mean())
        cv2.circle(mask, np.rint(face[iris[0], :2]).astype(int).tolist(), round(1.3 * radius), 0, -1)
        if mask.sum() >= 12:
            found.append(float((rgb[mask > 0].mean(axis=1) > WHITE_SHARE * skin).mean()))
    return found
