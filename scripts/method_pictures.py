"""`make pictures`: what each stage of the portrait method does, for docs/method.md.

The portrait is the public-domain photograph that comes with matplotlib; the driver is a built-in performance.
"""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from engine.face_animation.animation import ALL_PARTS, FaceAnimation, Parts, RegisteredDriver, RiggedTarget
from engine.face_animation.creases.fine_details import keep_ratio_images
from engine.face_animation.creases.registration import register_track
from engine.face_animation.driver_tracking.driver import track_driver
from engine.face_animation.driver_tracking.neutral import choose_neutral_frame
from engine.face_animation.face_rig import FaceRig, rig_target
from engine.face_animation.target_face import TargetFace
from engine.face_animation.warping.layers import Layers, separate_layers
from engine.imaging.composite import composite_over, upsample_twice, warp_layer
from engine.media.excerpt import Excerpt
from engine.media.limits import Limits
from engine.performances import video
from engine.portrait.options import PortraitOptions
from engine.portrait.target import find_target_face

OUT_FOLDER = Path(__file__).parent.parent / "docs" / "pictures"
SHOWN_PERFORMANCE, SHOWN_SECONDS = "surprise", 1.25
SIDE_PIXELS = 440
INK_RGB, DOT_RGB = (20, 90, 200), (230, 60, 40)
JPEG_QUALITY = 78

Picture = NDArray[np.uint8]


def main() -> None:
    """Write every picture."""
    options = PortraitOptions(crop="bust", size=(SIDE_PIXELS, SIDE_PIXELS))
    target = find_target_face(_portrait(), options, Limits(), lambda code, message: None)
    layers = separate_layers(target)
    rig = rig_target(target, layers)
    track = track_driver(Excerpt(video(SHOWN_PERFORMANCE), trim=(0.0, SHOWN_SECONDS + 0.5)))
    neutral = choose_neutral_frame(track, target.mesh, None).frame
    register_track(track, neutral)
    ratios = list(keep_ratio_images(track, neutral))
    frame = round(SHOWN_SECONDS * track.fps)

    def drawn(parts: Parts) -> Picture:
        animation = FaceAnimation(
            RiggedTarget(target, layers, rig), RegisteredDriver(track, neutral), options.acting(), parts=parts
        )
        motion = next(one for one in animation.motions() if one.frame == frame)
        return animation.draw(motion, ratios[frame])

    animation = FaceAnimation(RiggedTarget(target, layers, rig), RegisteredDriver(track, neutral), options.acting())
    motion = next(one for one in animation.motions() if one.frame == frame)
    moved = rig.mesh.offsets(np.column_stack([motion.offsets, motion.depth]))

    _write("method-control-points", _dots(target, rig, 0 * motion.offsets), _dots(target, rig, motion.offsets))
    _write("method-mesh", _wires(target, rig, 0 * moved[:, :2]), _wires(target, rig, moved[:, :2]))
    origin = rig.mesh.inverse_map(moved[:, :2], moved[:, 2])
    _write("method-field", _colours(origin), _warped(layers, rig, moved))
    _write("method-layers", _on_checks(layers.person), layers.plate)
    ratio = _shown_ratio(ratios[frame])
    crops = [_square(track.crop(one)) for one in (neutral, frame)]
    _write("method-ratio", *crops, _square(ratio))
    plain = Parts(hidden=False, details=False, own_folds=False, eyes=False)
    face = _box(target)
    stages = [target.rgb, drawn(plain), drawn(Parts(hidden=False, eyes=False)), drawn(ALL_PARTS)]
    _write("method-parts", *(_square(one[face]) for one in stages))


def _portrait() -> Path:
    package = find_spec("matplotlib")
    assert package is not None and package.origin is not None
    return Path(package.origin).parent / "mpl-data/sample_data/grace_hopper.jpg"


def _write(name: str, *pictures: Picture) -> None:
    gap = np.full((pictures[0].shape[0], 8, 3), 255, np.uint8)
    row = [one for picture in pictures for one in (picture, gap)][:-1]
    Image.fromarray(np.hstack(row)).save(OUT_FOLDER / f"{name}.jpg", quality=JPEG_QUALITY, optimize=True)


def _faded(rgb: Picture) -> Picture:
    return np.asarray(cv2.addWeighted(rgb, 0.55, np.full_like(rgb, 255), 0.45, 0), np.uint8)


def _dots(target: TargetFace, rig: FaceRig, offsets: NDArray[np.float32]) -> Picture:
    """The control points, and how far each one goes."""
    picture = _faded(target.rgb)
    for start, offset, usable in zip(rig.control.points, offsets, rig.control.usable, strict=True):
        if usable:
            end = start + offset
            cv2.line(picture, _pixel(start), _pixel(end), INK_RGB, 1, cv2.LINE_AA, 3)
            cv2.circle(picture, _pixel(end), 10, DOT_RGB, -1, cv2.LINE_AA, 3)
    return picture


def _wires(target: TargetFace, rig: FaceRig, offsets: NDArray[np.float32]) -> Picture:
    picture = _faded(target.rgb)
    points = np.round((rig.mesh.vertices + offsets) * 8).astype(np.int32)
    cv2.polylines(picture, list(points[rig.mesh.triangles]), True, INK_RGB, 1, cv2.LINE_AA, 3)
    return picture


def _colours(origin: NDArray[np.float32]) -> Picture:
    """Where each pixel comes from: the direction as a hue, the distance as its strength."""
    rows, columns = np.indices(origin.shape[:2], np.float32)
    here = np.dstack([columns, rows])
    away = np.where(origin > -1000, here - origin, 0)
    length = np.linalg.norm(away, axis=2)
    hue = (np.degrees(np.arctan2(away[..., 1], away[..., 0])) % 360) / 2
    strength = np.clip(length / np.percentile(length, 99), 0, 1) * 255
    hsv = np.dstack([hue, strength, np.full_like(hue, 255)]).astype(np.uint8)
    return np.asarray(cv2.cvtColor(hsv, cv2.COLOR_HSV2RGB), np.uint8)


def _warped(layers: Layers, rig: FaceRig, moved: NDArray[np.float32]) -> Picture:
    origin = rig.mesh.inverse_map(moved[:, :2], moved[:, 2], scale=2)
    return np.asarray(composite_over(warp_layer(upsample_twice(layers.person), origin), layers.plate), np.uint8)


def _on_checks(rgba: Picture) -> Picture:
    rows, columns = np.indices(rgba.shape[:2]) // 16
    checks = np.where((rows + columns) % 2, 255, 215)[..., None]
    alpha = rgba[..., 3:] / np.float32(255)
    return np.asarray(rgba[..., :3] * alpha + checks * (1 - alpha), np.uint8)


def _shown_ratio(ratio: NDArray[np.float32]) -> Picture:
    """A ratio of 1 as middle grey; darker is a crease, lighter a bulge."""
    grey = np.clip(128 + 255 * (ratio - 1), 0, 255).astype(np.uint8)
    return np.asarray(np.repeat(grey[..., None], 3, axis=2))


def _box(target: TargetFace) -> tuple[slice, slice]:
    centre = target.mesh[:, :2].mean(axis=0)
    half = 0.62 * float(np.ptp(target.mesh[:, 1]))
    left, top = np.maximum(centre - half, 0).astype(int)
    return slice(top, top + int(2 * half)), slice(left, left + int(2 * half))


def _square(picture: Picture, side: int = 300) -> Picture:
    return np.asarray(cv2.resize(picture, (side, side), interpolation=cv2.INTER_AREA), np.uint8)


def _pixel(point: NDArray[np.floating]) -> tuple[int, int]:
    return round(float(point[0]) * 8), round(float(point[1]) * 8)


if __name__ == "__main__":
    main()
