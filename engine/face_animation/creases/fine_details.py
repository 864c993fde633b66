"""Creases and wrinkles: expression ratio images, refined (section 6; Liu et al. 2001).

All ratio images live on the driver's neutral face: every frame is warped onto it, so that pixels correspond
over time, and one fixed map carries the ratios on to the still target; from there they are warped with it.
"""

from __future__ import annotations

import itertools
import os
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.face_animation.creases.outliers import Outliers, find_outliers
from engine.face_animation.creases.skin_in_both import SkinInBoth
from engine.face_animation.motion_transfer.head_motion import turn_angles
from engine.face_animation.shading_colour import shading_slopes
from engine.geometry.registration.rigid import fit_similarity
from engine.imaging.masks.colour_segmentation import grab_cut
from engine.imaging.warping.delaunay import delaunay
from engine.imaging.warping.mesh_warp import inverse_map
from engine.media.film_strip import FilmStrip, FilmStripWriter
from engine.perception.face.landmarks import FACE_OVAL, LEFT_EYE, LIPS_INNER, RIGHT_EYE, eye_distance, fiducials
from engine.perception.face_track.face_crop import CROP_EYE_DISTANCE_PIXELS, CROP_SHAPE
from engine.perception.face_track.track import FaceTrack

BRIGHTENING_FACTOR = 0.01
"""Section 6: ratios above one are tuned down by this factor."""
TEMPORAL_WINDOW_FRAMES = 21
"""Section 6: frames of the temporal Gaussian."""
SHADING_EYE_DISTANCES = 0.25
"""Ratios wider than this, in eye distances, are shading rather than creases."""
SHADING_SHARE = 0.25
"""Share by which ratios as wide as shading count in a head that does not turn."""
NO_SHADING_TURN_DEGREES = 12.0
"""Degrees of turn at which ratios as wide as shading count no more."""
CREASE_TURN_DEGREES = 8.0
"""Degrees of turn up to which a ratio is a crease's."""
NO_CREASE_TURN_DEGREES = 20.0
"""Degrees of turn from which on a ratio is the nose's shadow and no crease's."""
MIN_RATIO = 0.7
"""No crease darkens by more: a lower ratio is a shadow or a misfit."""
RATIO_QUANTUM = (1 - MIN_RATIO) / 192
"""How finely ratios are kept: a step is a third of a grey level on bright skin, and one itself is met exactly."""
RATIO_JPEG_QUALITY = 95
"""Of JPEG: less would flicker by half a level."""
RATIO_FLOOR_GREY_LEVELS = 12.0
"""Grey levels added to both sides of the ratio, so that noise in the dark does not become a crease."""
DRIVER_BLUR_PIXELS = 1.2
"""Pixels of the driver's crop: finer structure is noise of the video."""
NOSE_VERTICES = (6, 197, 195, 5, 4, 1, 2, 98, 327, 129, 358, 209, 429, 198, 420, 236, 456)
"""The nose: it hardly creases, but its own shadow and outline move with every turn."""
NOSE_SPARED_SHARE = 0.7
RIM_FADE_EYE_DISTANCES = 0.4
"""Within this distance of the face's rim, in eye distances, ratios fade out."""
GRABCUT_EYE_DISTANCE_PIXELS = 40.0
"""Eye distance, pixels, of the copy in which GrabCut tells the face from hair: the region is feathered by more than a pixel
of it."""
FLATNESS_EYE_DISTANCE_PIXELS = 60.0
"""Eye distance, pixels, of the copy in which flat colour is told from skin: what skin, paint and film have of grain is seen at it."""
FLAT_GREY_LEVELS, FLAT_WINDOW_PIXELS = 1.0, 5
"""Standard deviation within so many pixels, below which a place is of flat colour."""
FLAT_SHARES = (0.08, 0.2)
"""Flat shares of a face: up to the first it takes all of a ratio, from the second on none. Photographs, paintings and
rendered figures have up to 0.06, a drawing in flat colours 0.22."""


@dataclass(frozen=True)
class DetailRegion:
    """Where a target takes ratios.

    box : x0, y0, x1, y1 of the face in the target.
    corners : (468, 2) the mesh in it.
    triangles : (T, 3) of the mesh.
    weight : (h, w) [0, 1], the face's region without eyes and mouth, feathered.
    slopes : (3,) how far each channel darkens where luminance does (`shading_colour`).
    """

    box: tuple[int, int, int, int]
    corners: NDArray[np.float32]
    triangles: NDArray[np.int32]
    weight: NDArray[np.float32]
    slopes: NDArray[np.float32]

    def origin(self, neutral_mesh: NDArray[np.floating]) -> NDArray[np.float32]:
        """(h, w, 2): for each of its pixels the place on the driver's neutral crop, with its face at (478, 2)."""
        mesh = neutral_mesh[:468, :2].astype(np.float32)
        return inverse_map(self.corners, mesh, self.triangles, (self.weight.shape[0], self.weight.shape[1]))


def luminance(rgb: NDArray[np.uint8]) -> NDArray[np.float32]:
    """f of equation 2: the luminance (H, W) float32, lightly smoothed."""
    grey = cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY).astype(np.float32)
    return np.asarray(cv2.GaussianBlur(grey, (0, 0), DRIVER_BLUR_PIXELS), np.float32)


def face_region(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> NDArray[np.float32]:
    """The face with its forehead, without hair: an ellipse on the chin's points, refined by GrabCut.

    (H, W) float32 in [0, 1], feathered.
    """
    chin = fiducials(mesh[:, :2])[:17].astype(np.float32)
    unit = float(eye_distance(mesh[:, :2]))
    mirrored = 2 * mesh[168, :2] - chin  # the chin alone leaves the ellipse's top open
    ellipse = cv2.fitEllipse(np.concatenate([chin, mirrored[4:13]]).astype(np.float32))
    x0, y0 = np.maximum(np.floor(mesh[:, :2].min(axis=0) - unit), 0).astype(int)
    x1, y1 = np.minimum(np.ceil(mesh[:, :2].max(axis=0) + unit), rgb.shape[1::-1]).astype(int)
    scale = min(1.0, GRABCUT_EYE_DISTANCE_PIXELS / unit)
    patch = np.asarray(cv2.resize(rgb[y0:y1, x0:x1], None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA), np.uint8)
    centre = ((ellipse[0][0] - x0) * scale, (ellipse[0][1] - y0) * scale)
    axes = (ellipse[1][0] * scale, ellipse[1][1] * scale)
    probable, sure = np.zeros(patch.shape[:2], np.uint8), np.zeros(patch.shape[:2], np.uint8)
    cv2.ellipse(probable, (centre, axes, ellipse[2]), 1, -1)
    oval = ((mesh[list(FACE_OVAL), :2] - (x0, y0)) * scale).round().astype(np.int32)
    cv2.fillPoly(sure, [oval], 1)
    middle = cv2.erode(sure, np.ones((7, 7), np.uint8))
    likely = (probable | sure) > 0
    cut = grab_cut(patch, middle > 0, ~likely, likely, rounds=3).astype(np.float32)
    inside = cv2.GaussianBlur(cv2.erode(cut, np.ones((3, 3))), (0, 0), 2)
    region = np.zeros(rgb.shape[:2], np.float32)
    region[y0:y1, x0:x1] = cv2.resize(inside, (x1 - x0, y1 - y0), interpolation=cv2.INTER_LINEAR)
    return region


def detail_region(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> DetailRegion:
    """The part of the target (H, W, 3), with its face at `mesh` (478, 3), that creases."""
    plane = mesh[:468, :2].astype(np.float32)
    x0, y0 = np.maximum(np.floor(plane.min(axis=0)), 0).astype(int)
    x1, y1 = np.minimum(np.ceil(plane.max(axis=0)) + 1, rgb.shape[1::-1]).astype(int)
    corner = np.array([x0, y0], np.float32)
    triangles = delaunay(plane)
    weight = face_region(rgb, mesh)[y0:y1, x0:x1]
    weight *= inverse_map(plane - corner, plane, triangles, (y1 - y0, x1 - x0))[..., 0] > -1000
    weight *= 1 - _openings(plane - corner, weight.shape, 0.06 * float(eye_distance(mesh[:, :2])))
    unit = float(eye_distance(mesh[:, :2]))
    nose = np.zeros(weight.shape, np.float32)
    cv2.fillConvexPoly(nose, cv2.convexHull((plane[list(NOSE_VERTICES)] - corner).round().astype(np.int32)), 1.0)
    weight *= 1 - NOSE_SPARED_SHARE * cv2.GaussianBlur(nose, (0, 0), 0.1 * unit)
    oval = np.zeros((weight.shape[0] + 2, weight.shape[1] + 2), np.uint8)  # the driver's rim borders on its background
    cv2.fillPoly(oval, [(plane[list(FACE_OVAL)] - corner + 1).round().astype(np.int32)], 1)
    ramp = np.clip(
        cv2.distanceTransform(oval, cv2.DIST_L2, 5)[1:-1, 1:-1] / (RIM_FADE_EYE_DISTANCES * unit) - 0.25, 0, 1
    )
    box = (int(x0), int(y0), int(x1), int(y1))
    slopes = shading_slopes(rgb[y0:y1, x0:x1], weight, unit)
    weight *= 1 - flatness(rgb[y0:y1, x0:x1], weight, unit)
    return DetailRegion(box, plane - corner, triangles, (weight * ramp).astype(np.float32), slopes)


def flatness(rgb: NDArray[np.uint8], weight: NDArray[np.float32], unit: float) -> float:
    """How far a part of a picture (h, w, 3) is drawn in flat colours, from 0 to 1: on these a crease's soft shade is a
    stain. A `weight` (h, w) marks the part; `unit` is the eye distance in pixels."""
    scale = min(1.0, FLATNESS_EYE_DISTANCE_PIXELS / unit)
    grey = cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY).astype(np.float32)
    small, marks = (
        np.asarray(cv2.resize(one, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA), np.float32)
        for one in (grey, weight)
    )
    mean, squares = (cv2.blur(one, (FLAT_WINDOW_PIXELS, FLAT_WINDOW_PIXELS)) for one in (small, small * small))
    flat = (squares - mean * mean < FLAT_GREY_LEVELS**2)[marks > 0.5]
    low, high = FLAT_SHARES
    return float(np.clip((flat.mean() - low) / (high - low), 0, 1)) if len(flat) else 0.0


def _openings(mesh: NDArray[np.floating], shape: tuple[int, ...], grow: float) -> NDArray[np.float32]:
    """Eyes and mouth, where the layers of their own rule: (H, W) float32."""
    mask = np.zeros(shape, np.float32)
    for contour in (RIGHT_EYE, LEFT_EYE, LIPS_INNER):
        cv2.fillPoly(mask, [mesh[list(contour)].round().astype(np.int32)], 1.0)
    size = 2 * max(1, round(grow)) + 1
    grown = cv2.dilate(mask, np.ones((size, size), np.uint8))
    return np.asarray(cv2.GaussianBlur(grown, (0, 0), max(grow / 2, 0.8)), np.float32)


@dataclass(frozen=True)
class RatioStrip:
    """A driver's ratio images, kept: grey pictures whose level 0 stands for `MIN_RATIO`, each further one for `RATIO_QUANTUM`. Without `images`
    no creases are carried over: each ratio is one."""

    images: FilmStrip | None = None

    def __iter__(self) -> Iterator[NDArray[np.float32]]:
        """One (*CROP,) float32 for each frame."""
        frames = itertools.count() if self.images is None else range(len(self.images))
        return (self.ratio(frame) for frame in frames)

    def ratio(self, frame: int) -> NDArray[np.float32]:
        """One frame's, (*CROP,) float32."""
        if self.images is None:
            return np.ones(CROP_SHAPE, np.float32)
        return np.float32(MIN_RATIO) + np.float32(RATIO_QUANTUM) * self.images.picture(frame)


def keep_ratio_images(
    track: FaceTrack, neutral: int, tick: Callable[[float], None] = lambda fraction: None
) -> RatioStrip:
    """The refined ratio images of a driver on its neutral frame: the same for every target."""
    with FilmStripWriter(RATIO_JPEG_QUALITY) as writer:
        for frame, ratio in enumerate(RatioImages(track, neutral)):
            level = (ratio - np.float32(MIN_RATIO)) / np.float32(RATIO_QUANTUM) + np.float32(0.5)
            writer.write(np.clip(level, 0, 255).astype(np.uint8))
            tick((frame + 1) / len(track))
        return RatioStrip(writer.strip())


class RatioImages:
    """The ratio images of a driver, in order, on its neutral crop."""

    def __init__(self, track: FaceTrack, neutral: int, outliers: bool = True, refined: bool = True):
        self._track = track
        self._rest = track.in_crop(neutral)[:468]
        self._triangles = delaunay(self._rest)
        self._neutral = luminance(track.crop(neutral))
        self._skin = SkinInBoth(track.crop(neutral), self._rest)
        self._refined = refined
        turn = np.rad2deg(turn_angles(track.meshes, track.meshes[neutral]))
        self._frontal = SHADING_SHARE * np.clip(1 - turn / NO_SHADING_TURN_DEGREES, 0, 1).astype(np.float32)
        self._trusted = np.clip(
            (NO_CREASE_TURN_DEGREES - turn) / (NO_CREASE_TURN_DEGREES - CREASE_TURN_DEGREES), 0, 1
        ).astype(np.float32)
        self.outliers: Outliers | None = None
        if outliers:
            reference = most_expressive(track, neutral)
            ratio, origin = self._ratio(reference)
            self.outliers = find_outliers(ratio, origin, track, neutral, reference)

    def __iter__(self) -> Iterator[NDArray[np.float32]]:
        """One (*CROP,) float32 for each frame: 1 changes nothing."""
        half = TEMPORAL_WINDOW_FRAMES // 2
        kernel = np.exp(-0.5 * (np.arange(-half, half + 1) / (half / 3)) ** 2).astype(np.float32)
        window: deque[NDArray[np.float32]] = deque(maxlen=TEMPORAL_WINDOW_FRAMES)
        for ratio in self._singles(half):
            window.append(ratio)
            if len(window) == TEMPORAL_WINDOW_FRAMES:
                yield _weighted_sum(tuple(window), kernel / kernel.sum())

    def _singles(self, beyond: int) -> Iterator[NDArray[np.float32]]:
        """All frames without the temporal filter, in order, with `beyond` more before and after; made on all cores a little
        ahead. Beyond its ends a performance stands still, or repeats where it is closed."""
        count, threads = len(self._track), os.cpu_count() or 1
        places = np.arange(-beyond, count + beyond)
        frames = places % count if self._track.closed else places.clip(0, count - 1)
        waiting: deque[Future[NDArray[np.float32]]] = deque()
        with ThreadPoolExecutor(threads, thread_name_prefix="ratios") as pool:
            for before, frame in pairwise([-1, *frames.tolist()]):
                again = frame == before and bool(waiting)
                waiting.append(waiting[-1] if again else pool.submit(self.single, frame))
                if len(waiting) > 2 * threads:
                    yield waiting.popleft().result()
            while waiting:
                yield waiting.popleft().result()

    def single(self, frame: int) -> NDArray[np.float32]:
        """One frame's ratio image without the temporal filter."""
        ratio, origin = self._ratio(frame)
        if not self._refined:
            return ratio
        ratio = self._without_shading(ratio, frame)
        if self.outliers is not None:
            ratio = 1 + self.outliers.keep(origin, frame) * (ratio - 1)
        ratio = 1 + self._skin.share(self._track.crop(frame), origin) * (ratio - 1)
        return 1 + self._trusted[frame] * (_damped(ratio) - 1)

    def _without_shading(self, ratio: NDArray[np.float32], frame: int) -> NDArray[np.float32]:
        """A head that turns in fixed light changes shade over wide areas: no part of the expression."""
        small = cv2.resize(ratio, None, fx=1 / 8, fy=1 / 8, interpolation=cv2.INTER_AREA)
        wide = cv2.GaussianBlur(small, (0, 0), SHADING_EYE_DISTANCES * CROP_EYE_DISTANCE_PIXELS / 8) ** (
            1 - self._frontal[frame]
        )
        return np.asarray(ratio / cv2.resize(wide, ratio.shape[::-1], interpolation=cv2.INTER_LINEAR), np.float32)

    def _ratio(self, frame: int) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """Equation 2 on the neutral crop, and where each of its pixels lies in the frame's crop."""
        mesh = self._track.in_crop(frame)[:468]
        origin = inverse_map(self._rest, mesh, self._triangles, CROP_SHAPE)
        light = luminance(self._track.crop(frame))
        aligned = cv2.remap(light, origin[..., 0], origin[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        ratio = (aligned + RATIO_FLOOR_GREY_LEVELS) / (self._neutral + RATIO_FLOOR_GREY_LEVELS)
        return np.where(origin[..., 0] > -1000, ratio, 1).astype(np.float32), origin


def most_expressive(track: FaceTrack, neutral: int) -> int:
    """s_ref: the frame whose fiducials are furthest from the neutral's after a similarity (section 6)."""
    rest = fiducials(track.meshes[neutral, :, :2]).astype(float)
    far = []
    for mesh in track.meshes[..., :2]:
        points = fiducials(mesh).astype(float)
        far.append(np.linalg.norm(fit_similarity(rest, points)(rest) - points, axis=1).mean() / eye_distance(mesh))
    return int(np.argmax(np.where(track.found, far, -1)))


def shade(
    frame: NDArray[np.uint8],
    region: DetailRegion,
    landing: NDArray[np.float32],
    ratio: NDArray[np.float32],
    origin: NDArray[np.float32],
    scale: float,
    within: NDArray[np.floating] | None = None,
    strength: float = 1.0,
) -> None:
    """Equation 3: multiply the warped target (H, W, 3), in place, by the warped ratio where its region allows, with a
    `strength` from 0 to 1. Each channel is multiplied as far as the target's own skin darkens in the shade.

    `landing` is the region's origin on the driver's neutral crop. `origin` (H, W, 2) is the frame's inverse map, in
    pixels of the target enlarged by `scale`. `within` are points (V, 2) of the frame around which its face ends, if
    known.
    """
    x0, y0 = region.box[:2]
    change = cv2.remap(ratio, landing, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)  # type: ignore[call-overload]
    change -= 1
    change *= region.weight
    left, top, right, bottom = 0, 0, frame.shape[1], frame.shape[0]
    if within is not None:
        left, top = np.clip(np.floor(within.min(axis=0)).astype(int) - 1, 0, (right, bottom)).tolist()
        right, bottom = np.clip(np.ceil(within.max(axis=0)).astype(int) + 2, 0, (right, bottom)).tolist()
    there = (slice(top, bottom), slice(left, right))
    place = np.float32(x0), np.float32(y0), np.float32(1 / scale)
    _multiply(frame[there], change, np.float32(strength) * region.slopes, origin[there], *place)


@njit(fastmath=True, nogil=True)
def _multiply(rgb, change, strengths, origin, x0, y0, shrink):  # type: ignore[no-untyped-def]
    """The colours changed by bilinear samples of `change`, which lies at (x0, y0) of the target, each channel with its strength."""
    rows, columns = change.shape
    for y in range(rgb.shape[0]):
        for x in range(rgb.shape[1]):
            fx = (origin[y, x, 0] + np.float32(0.5)) * shrink - np.float32(0.5) - x0
            fy = (origin[y, x, 1] + np.float32(0.5)) * shrink - np.float32(0.5) - y0
            if fx < 0 or fy < 0 or fx >= columns - 1 or fy >= rows - 1:
                continue
            ix, iy = int(fx), int(fy)
            tx, ty = fx - ix, fy - iy
            top = change[iy, ix] + tx * (change[iy, ix + 1] - change[iy, ix])
            bottom = change[iy + 1, ix] + tx * (change[iy + 1, ix + 1] - change[iy + 1, ix])
            value = top + ty * (bottom - top)
            if abs(value) > 1e-3:
                for k in range(3):
                    rgb[y, x, k] = np.uint8(min(255.0, rgb[y, x, k] * (1 + strengths[k] * value) + 0.5))


def _damped(ratio: NDArray[np.float32]) -> NDArray[np.float32]:
    """Section 6, "robustness to saturation": for R > 1, 1 + 0.01 (R - 1)."""
    return np.where(ratio > 1, 1 + BRIGHTENING_FACTOR * (ratio - 1), np.maximum(ratio, MIN_RATIO)).astype(np.float32)


def _weighted_sum(images: tuple[NDArray[np.float32], ...], weights: NDArray[np.float32]) -> NDArray[np.float32]:
    out = np.zeros_like(images[0])
    for image, weight in zip(images, weights, strict=True):
        if weight > 1e-3:
            cv2.scaleAdd(image, float(weight), out, out)
    return out
