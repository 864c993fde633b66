"""No flicker where the driver holds still, and no bent walls where the head moves."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from made_clip import face, unpacked, write_frames
from numpy.typing import NDArray

from engine.face_animation.animation import FaceAnimation, RegisteredDriver, RiggedTarget
from engine.face_animation.creases.fine_details import RatioImages
from engine.face_animation.creases.registration import register_track
from engine.face_animation.driver_tracking.driver import track_driver
from engine.face_animation.face_rig import rig_target
from engine.face_animation.warping.layers import Layers, separate_layers
from engine.media.excerpt import Excerpt
from engine.media.image import read_image, write_image
from engine.media.limits import Limits
from engine.perception.face.landmarks import FACE_OVAL
from engine.perception.masks.person import person_mask
from engine.portrait.options import PortraitOptions
from engine.portrait.target import find_target_face

STILL_GREY_LEVELS = 0.5
"""Grey levels of temporal deviation inside the face that pass for none."""
NOISE_GREY_LEVELS = 2.0
"""Grey levels: a phone's sensor indoors."""
STEP_PIXELS, WALL_GREY_LEVEL, LINE_DARKENING = 16, 170.0, 110.0
"""Pixels between the lines of the grid; brightness of the wall; how much darker a line is in its middle."""


def face_mask(frame: NDArray[np.uint8]) -> NDArray[np.bool_]:
    mask = np.zeros(frame.shape[:2], np.uint8)
    cv2.fillPoly(mask, [face(frame)[list(FACE_OVAL), :2].round().astype(np.int32)], 1)
    return mask > 0


def test_a_driver_that_holds_still_gives_a_still_face(animation, clip, woman_white, tmp_path: Path) -> None:
    """One real frame 40 times, with fresh sensor noise each: the face's brightness deviates by half a level at most."""
    frame = clip("woman_talk_aoc.mp4", 1.0, 1.1)[0].astype(float)
    rng = np.random.default_rng(0)
    noisy = [
        np.clip(frame + rng.normal(0, NOISE_GREY_LEVELS, frame.shape) + 0.5, 0, 255).astype(np.uint8) for _ in range(40)
    ]
    driver = write_frames(tmp_path / "still.mp4", noisy, 30, crf=1)
    frames = np.array(unpacked(animation(woman_white, driver, format="png").out / "animation.zip"), np.float32)
    deviation = frames.std(axis=0).mean(axis=2)[face_mask(frames[0].astype(np.uint8))]
    assert deviation.mean() <= STILL_GREY_LEVELS
    assert np.quantile(deviation, 0.99) <= 4.0  # inside the lips the driver's own noise shows


def test_a_still_face_stays_still_with_its_mouth_open(animation, clip, woman_white, tmp_path: Path) -> None:
    """The mouth's inside is made from each frame anew, and does not flicker either."""
    rest, wide = (clip("man_mouth_open_d18.mp4", s, s + 0.05)[0].astype(float) for s in (1.5, 2.8))
    rng = np.random.default_rng(0)
    acted = [rest] * 12 + [wide] * 40
    noisy = [np.clip(f + rng.normal(0, NOISE_GREY_LEVELS, f.shape) + 0.5, 0, 255).astype(np.uint8) for f in acted]
    driver = write_frames(tmp_path / "open.mp4", noisy, 30, crf=1)
    made = animation(woman_white, driver, neutral_frame=0, format="png")
    frames = np.array(unpacked(made.out / "animation.zip")[28:], np.float32)  # past the ratio images' window
    assert frames.std(axis=0).mean(axis=2)[face_mask(frames[0].astype(np.uint8))].mean() <= STILL_GREY_LEVELS


def wall(shape: tuple[int, int]) -> NDArray[np.float64]:
    """A bright wall with thin dark lines every `STEP_PIXELS` pixels, both ways, their middles at half pixels."""
    y, x = np.mgrid[: shape[0], : shape[1]].astype(float)
    dark = np.zeros(shape)
    for axis in (x, y):
        away = (axis - STEP_PIXELS / 2 + 0.5) % STEP_PIXELS
        dark = np.maximum(dark, np.exp(-0.5 * (np.minimum(away, STEP_PIXELS - away) / 1.0) ** 2))
    return np.asarray(WALL_GREY_LEVEL - LINE_DARKENING * dark)


def line_errors(frame: NDArray, visible: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Pixels by which the horizontal lines of the wall are off, wherever one is seen whole between two crossings."""
    grey = frame.astype(float).mean(axis=2)
    errors = []
    for y in np.arange(STEP_PIXELS / 2 - 0.5, frame.shape[0] - 8, STEP_PIXELS):
        rows = np.arange(round(y - 4.5), round(y + 5.5))
        if rows[0] < 0:
            continue
        for x in range(frame.shape[1]):
            if (
                (x - STEP_PIXELS / 2 + 0.5) % STEP_PIXELS < 5
                or (x - STEP_PIXELS / 2 + 0.5) % STEP_PIXELS > STEP_PIXELS - 5
                or not visible[rows, x].all()
            ):
                continue
            dark = np.clip(WALL_GREY_LEVEL - 12 - grey[rows, x], 0, None)
            errors.append(abs(float((rows * dark).sum() / dark.sum()) - y) if dark.sum() > 60 else np.inf)
    return np.array(errors)


def test_straight_lines_behind_a_moving_head_stay_straight(clip, small, tmp_path: Path) -> None:
    """A grid drawn on the background deviates by half a pixel at most outside the person; both ways round."""
    rgb = read_image(small("photo_woman_outdoor.jpg", 320)).rgb
    alpha = person_mask(rgb)[..., None]
    drawn = np.clip(alpha * rgb + (1 - alpha) * wall(rgb.shape[:2])[..., None] + 0.5, 0, 255).astype(np.uint8)
    write_image(tmp_path / "wall.png", drawn)
    driver = write_frames(tmp_path / "tilts.mp4", clip("man_talk_tps.mp4", 0.6, 1.8)[::2])
    options = PortraitOptions()
    target = find_target_face(tmp_path / "wall.png", options, Limits(), lambda code, message: None)
    layers = separate_layers(target)
    track = track_driver(Excerpt(driver))
    track = replace(track, meshes=register_track(track, 0).meshes)
    rig = rig_target(target, layers)
    black = Layers(layers.person, np.zeros_like(layers.plate))
    white = Layers(layers.person, np.full_like(layers.plate, 255))
    moved = np.zeros(rgb.shape[:2])
    for frame, low, high in zip(
        *(
            FaceAnimation(RiggedTarget(target, some, rig), RegisteredDriver(track, 0), options.acting()).frames(
                RatioImages(track, 0)
            )
            for some in (layers, black, white)
        ),
        strict=True,
    ):
        seen_through = (high.astype(float) - low).mean(axis=2) / 255
        moved = np.maximum(moved, np.abs(seen_through - (1 - layers.person[..., 3] / 255)))
        outside = (seen_through > 0.99) & (alpha[..., 0] < 0.01)
        for errors in (
            line_errors(frame, outside),
            line_errors(frame.transpose(1, 0, 2), outside.T),
        ):
            assert len(errors) > 300
            assert errors.max() <= 0.5
    assert (moved > 0.5).sum() > 500, "the head does move over the wall"


def test_the_measure_sees_a_bent_wall() -> None:
    """A wall that bends by a pixel is found to be off by a pixel: the test above could fail."""
    straight = np.repeat(wall((160, 160))[..., None], 3, axis=2)
    assert line_errors(straight, np.ones((160, 160), bool)).max() < 0.1
    y, x = np.mgrid[:160, :160].astype(np.float32)
    bent = cv2.remap(
        straight, x, y + np.sin(x / 25).astype(np.float32), cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE
    )
    assert 0.8 < line_errors(bent, np.ones((160, 160), bool)).max() < 1.2
