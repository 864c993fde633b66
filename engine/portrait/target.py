"""The target: one picture is read, the face in it that is to act is chosen, checked, and brought to the result's size."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.export.videos.animated_gif import MAX_GIF_SIDE_PIXELS
from engine.face_animation.eyes.lower_lids import fit_lower_lids
from engine.face_animation.target_face import TargetFace
from engine.imaging.resample import even_size
from engine.media.image import over_grey, read_image
from engine.media.limits import Limits
from engine.perception.expression.features import EXPRESSION_FEATURES, measure_expression
from engine.perception.face.faces import find_faces, same_face
from engine.perception.face.head_pose import head_pose, mesh_from_fiducials
from engine.perception.face.landmarks import FACE_OVAL, eye_distance, eye_opening, mouth_opening
from engine.perception.masks.segmentation import people_confidence
from engine.portrait.options import PortraitOptions
from engine.run import ConcurrentStage, Run

MAX_PICTURE_SIDE_PIXELS = 1920
"""Pixels of the result by default (the project's conventions)."""
MAX_REACTIVE_SIDE_PIXELS = 640
"""Pixels of a reactive profile by default: pages show one smaller than that, and all of its clips are loaded."""
MIN_TARGET_EYE_DISTANCE_PIXELS = 16.0
"""Pixels; a smaller face has nothing to animate."""
MAX_TARGET_TURN_DEGREES = (35.0, 30.0)
"""Degrees of yaw and pitch beyond which a target fails; see the limits in the documentation."""
MAX_TARGET_MOUTH_OPENING = 0.6
"""Mouth opening beyond which a target fails: its teeth, or the driver's in their place, would be drawn too long. The
widest of real portraits is 0.2, of people who speak 0.5, of a shout 0.8."""
NEUTRAL_LIMITS = (12.0, 12.0, 0.08, 0.03)
"""Degrees of yaw and pitch, mouth opening, and eye distances by which the mouth's corners lie above the middle of the
lips, up to which a target counts as neutral and frontal. The corners of neutral portraits lie up to 0.012 above it, of
smiles with closed lips from 0.035; their widths do not tell the two apart."""

MIN_UNCUT_FACE_SHARE = 0.95
"""Share of the face that lies in the result below which it counts as cut."""
MIN_FACE_INSIDE_SHARE = 0.5
"""Share of a placed face that lies in the picture; of one that reaches further out, nothing is left to move."""
CROP_WITHOUT_FACE = "The crop leaves the face out: let it hold more than half of it."
SHUT_EYE_OPENING = 0.13
"""Gap between an eye's lids, over its width, below which it is shut, and no eyeball is found (`engine.face_animation.eyes.eyes`): calm
people have 0.22 to 0.43, a laugh 0.2."""


def look_for_face(path: Path, options: PortraitOptions, run: Run) -> ConcurrentStage[TargetFace]:
    """Begin to look for the face that is to act, which nothing else has to wait for."""
    return run.beside("find_face", find_target_face, path, options.framing(), run.limits, run.warn)


def find_target_face(
    path: Path, options: PortraitOptions, limits: Limits, warn: Callable[[str, str], None]
) -> TargetFace:
    """Read the picture, choose the face, and bring both to the result's size.

    Raises
    ------
    InputError : `no_face`, `crop_outside`, `landmarks_invalid`, `face_index_out_of_range`, `face_too_small`,
    `face_too_turned`, `mouth_too_open`, and what reading a picture may raise.
    """
    picture = read_image(path, limits)
    height, width = picture.rgb.shape[:2]
    with ThreadPoolExecutor(1, thread_name_prefix="people") as beside:
        whole = options.crop == "none" and picture.alpha is None
        people = beside.submit(people_confidence, picture.rgb).result if whole else lambda: None
        meshes, index = _look(over_grey(picture.rgb, picture.alpha), options, warn)
    boxes = np.array([[*m[:, :2].min(axis=0), *np.ptp(m[:, :2], axis=0)] for m in meshes], np.float32)
    found = {"faces": in_pixels(boxes)}
    if index >= len(meshes):
        where, mends = (
            ("crop", ("face_index", "crop")) if isinstance(options.crop, tuple) else ("picture", ("face_index",))
        )
        raise InputError(
            "face_index_out_of_range",
            f"The {where} shows {len(meshes)} face(s): face_index counts from 0.",
            mends,
            found,
        )
    mesh = meshes[index]
    place, size = _placement(mesh, (width, height), options)
    _check_face(mesh, (width, height), options, warn, found)
    rgb = _warp(picture.rgb, place, size)
    alpha = None if picture.alpha is None else _warp(picture.alpha, place, size)
    moved = mesh.copy()
    scale = float(place[0, 0])
    moved[:, :2] = (mesh[:, :2] + 0.5) * scale + place[:, 2] - 0.5
    moved[:, 2] *= scale
    if float(eye_distance(moved[:, :2])) < MIN_TARGET_EYE_DISTANCE_PIXELS:
        raise InputError(
            "face_too_small",
            f"The face is too small: its eyes must be at least {MIN_TARGET_EYE_DISTANCE_PIXELS:.0f} pixels apart. Crop to the face or use a larger picture.",
            ("crop", "size", "face_index"),
            found,
        )
    if share_inside(moved, size) < MIN_UNCUT_FACE_SHARE:
        warn(
            "face_cut",
            "The picture cuts the face: what lies beyond its edge is not known, and cannot move in. Use a picture, or a crop, that shows all of it.",
        )
    if options.landmarks is None:
        moved = fit_lower_lids(rgb, moved)
    return TargetFace(rgb, alpha, moved, boxes, (width, height), place, people())


def _look(
    rgb: NDArray[np.uint8], options: PortraitOptions, warn: Callable[[str, str], None]
) -> tuple[list[NDArray[np.float32]], int]:
    """The faces of a picture, the largest first, and which of them is to act. With a crop by numbers, those in the crop."""
    height, width = rgb.shape[:2]
    x0, y0, x1, y1 = _part(options, (width, height))
    part = (int(x0), int(y0), int(np.ceil(x1)), int(np.ceil(y1)))
    meshes = find_faces(rgb, within=part)
    if options.landmarks is not None:
        return _with_placed(mesh_from_fiducials(np.array(options.landmarks)), meshes, (width, height), options, warn)
    if not meshes and part != (0, 0, width, height):  # it may cut a face so that it is no longer seen in it alone
        everybody = find_faces(rgb)
        meshes = [mesh for mesh in everybody if _mostly_in(mesh, (x0, y0, x1, y1))]
        if everybody and not meshes:
            raise InputError("crop_outside", CROP_WITHOUT_FACE, ("crop",))
    if not meshes:
        raise InputError(
            "no_face",
            "No face was found in the picture: use one that shows a face from the front, crop to where it is, or place the landmarks by hand.",
            ("landmarks", "crop"),
        )
    return meshes, options.face_index


def _with_placed(
    placed: NDArray[np.float32],
    meshes: list[NDArray[np.float32]],
    size: tuple[int, int],
    options: PortraitOptions,
    warn: Callable[[str, str], None],
) -> tuple[list[NDArray[np.float32]], int]:
    """The faces that were found, with the placed one instead of the one that it lies on, or after all of them; and its
    place among them."""
    if share_inside(placed, size) < MIN_FACE_INSIDE_SHARE:
        raise InputError(
            "landmarks_invalid",
            "The placed landmarks lie outside of the picture: give them in pixels of the picture as it was uploaded, with more than half of the face inside.",
            ("landmarks",),
        )
    index = next((i for i, mesh in enumerate(meshes) if same_face(mesh, placed)), len(meshes))
    if options.face_index not in (0, index):
        warn(
            "face_index_ignored",
            f"The placed landmarks are not those of the face that face_index {options.face_index} names: the landmarks count.",
        )
    return [*meshes[:index], placed, *meshes[index + 1 :]], index


def share_inside(mesh: NDArray[np.floating], size: tuple[int, int]) -> float:
    """How much of a face's mesh (478, 2 or 3) lies in a picture of `size` (w, h): a share of its area."""
    oval = cv2.convexHull(mesh[list(FACE_OVAL), :2].astype(np.float32))
    (width, height), start = size, -0.5
    picture = np.array([[0, 0], [width, 0], [width, height], [0, height]], np.float32) + np.float32(start)
    area = float(cv2.contourArea(oval))
    return float(cv2.intersectConvexConvex(oval, picture)[0]) / max(area, 1e-6)


def in_pixels(boxes: NDArray[np.float32]) -> list[list[float]]:
    """Boxes (F, 4) as JSON, in tenths of a pixel."""
    return [[round(float(value), 1) for value in box] for box in boxes]


def _check_face(
    mesh: NDArray[np.float32],
    size: tuple[int, int],
    options: PortraitOptions,
    warn: Callable[[str, str], None],
    found: dict[str, list[list[float]]],
) -> None:
    if options.landmarks is not None:
        return
    pose = head_pose(mesh, size)
    yaw, pitch = np.rad2deg(abs(pose.yaw)), np.rad2deg(abs(pose.pitch))
    if yaw > MAX_TARGET_TURN_DEGREES[0] or pitch > MAX_TARGET_TURN_DEGREES[1]:
        raise InputError(
            "face_too_turned",
            f"The face is turned by {yaw:.0f} degrees sideways and {pitch:.0f} up or down; at most {MAX_TARGET_TURN_DEGREES[0]:.0f} and {MAX_TARGET_TURN_DEGREES[1]:.0f} can be animated. Use a more frontal picture.",
            ("landmarks", "face_index"),
            found,
        )
    opening = float(mouth_opening(mesh))
    if opening > MAX_TARGET_MOUTH_OPENING:
        raise InputError(
            "mouth_too_open",
            "The mouth is open too wide for another expression to be shown: use a picture with a calmer face, or place the landmarks by hand.",
            ("landmarks", "face_index"),
            found,
        )
    smile = float(measure_expression(mesh[None])[0, EXPRESSION_FEATURES.index("corners_up")])
    words = "is turned sideways", "looks up or down", "has its mouth open", "smiles"
    if shown := [
        word
        for word, value, most in zip(words, (yaw, pitch, opening, smile), NEUTRAL_LIMITS, strict=True)
        if value > most
    ]:
        warn(
            "target_not_neutral",
            f"The face {' and '.join(shown)}: what the driver does is added to that. A calm face from the front can do more.",
        )
    if float(eye_opening(mesh).min()) < SHUT_EYE_OPENING:
        warn(
            "eyes_shut",
            "An eye is shut in the picture and stays so: what is behind the lid is not known. Use a picture with open eyes.",
        )


def _placement(
    mesh: NDArray[np.float32], size: tuple[int, int], options: PortraitOptions
) -> tuple[NDArray[np.float64], tuple[int, int]]:
    """(2, 3) scale and shift (for pixel corners) from the picture to the result, and the result's (w, h)."""
    box = _crop_box(mesh, size, options)
    if options.size is not None:
        scale = min(options.size[0] / box[2], options.size[1] / box[3])
    else:
        longest = (
            MAX_REACTIVE_SIDE_PIXELS
            if options.reactive
            else MAX_GIF_SIDE_PIXELS
            if options.format == "gif"
            else MAX_PICTURE_SIDE_PIXELS
        )
        scale = min(1.0, longest / max(box[2], box[3]))
    out = even_size(box[2] * scale, box[3] * scale)
    return np.array([[scale, 0, -box[0] * scale], [0, scale, -box[1] * scale]]), out


def _crop_box(mesh: NDArray[np.float32], size: tuple[int, int], options: PortraitOptions) -> tuple[float, ...]:
    if options.crop == "none":
        return 0.0, 0.0, float(size[0]), float(size[1])
    if isinstance(options.crop, tuple):
        x0, y0, x1, y1 = part = _part(options, size)
        if not _mostly_in(mesh, part):
            raise InputError("crop_outside", CROP_WITHOUT_FACE, ("crop",))
        return x0, y0, x1 - x0, y1 - y0
    centre = mesh[:, :2].mean(axis=0)
    side = float(np.ptp(mesh[:, 1])) * (1.9 if options.crop == "face" else 3.2)
    up = 0.55 if options.crop == "face" else 0.4
    x0, y0 = max(centre[0] - side / 2, 0.0), max(centre[1] - side * up, 0.0)
    return x0, y0, min(side, size[0] - x0), min(side, size[1] - y0)


def _part(options: PortraitOptions, size: tuple[int, int]) -> tuple[float, float, float, float]:
    """What a crop by numbers leaves of a picture of `size` (w, h), or all of it: x0, y0, x1, y1."""
    if not isinstance(options.crop, tuple):
        return 0.0, 0.0, float(size[0]), float(size[1])
    x, y, width, height = options.crop
    x0, y0 = max(x, 0.0), max(y, 0.0)
    x1, y1 = min(x + width, float(size[0])), min(y + height, float(size[1]))
    if x1 - x0 < 16 or y1 - y0 < 16:
        raise InputError("crop_outside", "The crop lies outside the picture or is smaller than 16 pixels.", ("crop",))
    return x0, y0, x1, y1


def _mostly_in(mesh: NDArray[np.float32], part: tuple[float, float, float, float]) -> bool:
    """Whether more than half of a face's width and height lies in a part of the picture: x0, y0, x1, y1."""
    low, high = mesh[:, :2].min(axis=0), mesh[:, :2].max(axis=0)
    return bool((np.minimum(part[2:], high) - np.maximum(part[:2], low) >= (high - low) / 2).all())


def _warp(image: NDArray, place: NDArray[np.float64], size: tuple[int, int]) -> NDArray:
    matrix = place.copy()
    matrix[:, 2] += 0.5 * place[0, 0] - 0.5  # pixel centres
    if place[0, 0] == 1 and not (matrix[:, 2] % 1).any():
        x, y = (-matrix[:, 2]).astype(int)
        cut = image[y : y + size[1], x : x + size[0]]
        if cut.shape[:2] == size[::-1]:
            return np.ascontiguousarray(cut)
    if place[0, 0] < 1:  # area filter first, then the exact placement
        source = cv2.GaussianBlur(image, (0, 0), 0.35 / place[0, 0])
        return cv2.warpAffine(source, matrix, size, flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return cv2.warpAffine(image, matrix, size, flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
