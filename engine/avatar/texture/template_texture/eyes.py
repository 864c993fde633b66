"""The template's eyeballs, painted, and brought to the colours that frames show of the person's."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.texture.template_texture.iris_in_frame import iris_centre
from engine.avatar.texture.views import ChartedSurface, FrameView
from engine.imaging.histogram_matching import from_lab, to_lab
from engine.media.colour_conversion.tone_mapping import srgb_code
from engine.performances.modelling.eyes import EYEBALL_RADIUS_METRES, IRIS_RADIUS, PUPIL_RADIUS, colour_of_eye
from engine.render.rasterisation.visibility import depth_buffer, seen_points
from engine.render.textures.sampling import bilinear

LID_THICKNESS_METRES = 5e-4
"""Metres behind the surface at which a point of an eyeball still counts as seen: lids are thin."""
BEST_VIEW_COUNT = 6
"""Frames of an eye that are asked: those that have most pixels on its iris."""
MIN_GAZE_COSINE = 0.85
"""Of the angle between where an eye looks and the way to the camera."""
IRIS_BAND_METRES, WHITE_BAND_METRES = (1.15 * PUPIL_RADIUS, 0.9 * IRIS_RADIUS), (1.15 * IRIS_RADIUS, 2.1 * IRIS_RADIUS)
"""Metres from the axis of gaze between which samples are of the iris, and of the white; a pixel of the frame less."""
MAX_MARGIN_METRES = 0.25 * IRIS_RADIUS
"""Metres that a pixel counts as a margin, at most, so that something is left of an iris filmed from afar."""
MIN_EYE_SAMPLE_COUNT = 40
"""Below which an eye's colours stay the template's."""
WHITE_LIGHTNESS_QUANTILES, MAX_WHITE_CHROMA = (0.5, 0.92), 22.0
"""Quantiles of lightness between which samples of the white count: lids, lashes and their shadow are darker, highlights lighter; and
the most chroma."""
IRIS_LIGHTNESS_QUANTILES = (0.2, 0.7)
"""Quantiles of lightness between which samples of the iris count: lashes and the pupil are darker, highlights and what
they mirror lighter."""
MAX_IRIS_CONTRAST_RATIO = 0.75
"""Of the painted spread of lightness, what a person's has at most: what is painted is for an eye that fills a picture."""


@dataclass(frozen=True)
class Eyeballs:
    """Places on one of the template's eyeballs: `places` (N, 3) metres from its middle, looking along +z, scaled to the radius
    of `engine.performances.modelling.eyes`; `triangles` (N,), `shares` (N, 3): where they lie on the surface."""

    places: NDArray[np.float64]
    triangles: NDArray[np.intp]
    shares: NDArray[np.float32]

    @staticmethod
    def of(
        offsets: NDArray[np.floating],
        radius: float,
        iris: float,
        triangles: NDArray[np.intp],
        shares: NDArray[np.float32],
    ) -> Eyeballs:
        """Of an eyeball of a `radius`, metres, with an `iris` of another: places (N, 3) from its middle in whatever scale, moved over
        the ball so that the iris ends where the painted one does."""
        places = np.asarray(offsets, np.float64)
        places = EYEBALL_RADIUS_METRES * places / np.linalg.norm(places, axis=1, keepdims=True)
        off = np.hypot(places[:, 0], places[:, 1])
        ends = [0, min(iris / radius, 0.9) * EYEBALL_RADIUS_METRES, EYEBALL_RADIUS_METRES]
        painted = np.where(places[:, 2] > 0, np.interp(off, ends, [0, IRIS_RADIUS, EYEBALL_RADIUS_METRES]), off)
        across = places[:, :2] * (painted / np.maximum(off, 1e-12))[:, None]
        ahead = np.sign(places[:, 2]) * np.sqrt(np.maximum(EYEBALL_RADIUS_METRES**2 - painted**2, 0))
        return Eyeballs(np.column_stack([across, ahead]), triangles, shares)

    @property
    def off_axis(self) -> NDArray[np.float64]:
        """(N,) metres from the axis of gaze; behind the middle as far as a place can be."""
        off = np.hypot(self.places[:, 0], self.places[:, 1])
        return np.where(self.places[:, 2] > 0, off, EYEBALL_RADIUS_METRES)

    def gaze(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """(3,) the unit vector along which the eye looks whose places are at `points` (N, 3) metres."""
        ahead = _pupil(points, self.off_axis) - points.mean(0)
        return np.asarray(ahead / np.linalg.norm(ahead))


def painted_eyes(eyes: Eyeballs) -> NDArray[np.float32]:
    """(N, 3) sRGB, 0 to 255, of eyeballs as they look from the front; the back is white."""
    places = eyes.places.copy()
    behind = places[:, 2] <= 0
    away = np.maximum(np.hypot(places[:, 0], places[:, 1]), 1e-9)
    places[behind, :2] *= (EYEBALL_RADIUS_METRES / away[behind])[:, None]
    places[behind, 2] = 0
    ahead = np.broadcast_to([0.0, 0.0, 1.0], places.shape)
    albedo, _ = colour_of_eye(places, ahead)
    return np.asarray(255 * srgb_code(np.clip(albedo, 0, 1)), np.float32)


def persons_eyes(
    colours: NDArray[np.float32], eyes: Eyeballs, iris: NDArray[np.floating], white: NDArray[np.floating]
) -> NDArray[np.float32]:
    """Painted eyeballs in a person's colours: `iris` (M, 3) and `white` (K, 3) are sRGB samples of frames. Pupils stay."""
    off = eyes.off_axis
    out = colours.copy()
    on_iris, on_white = (off > PUPIL_RADIUS) & (off < IRIS_RADIUS), off >= IRIS_RADIUS
    if len(iris) >= MIN_EYE_SAMPLE_COUNT:
        out[on_iris] = _toned(colours[on_iris], iris)
    if len(white) >= MIN_EYE_SAMPLE_COUNT:
        out[on_white] = _toned(colours[on_white], white)
    # the rims of iris and pupil are soft: there the new colours come in by and by
    soft = np.clip((off - PUPIL_RADIUS) / (0.15 * PUPIL_RADIUS), 0, 1)[:, None].astype(np.float32)
    return np.where(on_iris[:, None], colours + soft * (out - colours), out).astype(np.float32)


def _toned(colours: NDArray[np.floating], reference: NDArray[np.floating]) -> NDArray[np.float32]:
    """Painted colours (N, 3) about the median of the reference (M, 3). They are at most as much lighter and darker than
    that as what frames show is, and as its lightness leaves room for: dark eyes are plain."""
    own, goal = to_lab(colours), to_lab(reference)
    middle, own_middle = np.median(goal, 0), np.median(own, 0)
    spread = np.subtract(*np.quantile(goal, (0.75, 0.25), axis=0))
    own_spread = np.subtract(*np.quantile(own, (0.75, 0.25), axis=0))
    room = min(float(middle[0] / own_middle[0]), MAX_IRIS_CONTRAST_RATIO)
    return from_lab(middle + np.minimum(spread / np.maximum(own_spread, 1e-6), room) * (own - own_middle))


def eye_samples(
    surface: ChartedSurface,
    eyes: Eyeballs,
    views: Sequence[FrameView],
    gains: NDArray[np.floating],
    shadow: NDArray[np.floating],
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Colours (M, 3) of the iris and (K, 3) of the white, sRGB, that the frames show best; none where none shows any.

    `surface`: the fitted person. `gains` (N, 3) of the views. `shadow` (N,): what lids leave of the light at each place: the
    white is told by the lighter half of what a frame shows.
    """
    off = eyes.off_axis
    corners = surface.vertices[surface.triangles[eyes.triangles]]
    points = np.einsum("nk,nkd->nd", eyes.shares, corners)
    pupil, gaze = _pupil(points, off), eyes.gaze(points)
    ranked = sorted(((_pixels(view, pupil, gaze), n) for n, view in enumerate(views)), reverse=True)
    iris, white = [np.zeros((0, 3), np.float32)], [np.zeros((0, 3), np.float32)]
    for fineness, n in ranked[:BEST_VIEW_COUNT]:
        if fineness <= 0:
            break
        camera = views[n].camera
        pixels = camera.project(points)
        seen = seen_points(depth_buffer(camera, surface.vertices, surface.triangles), pixels, LID_THICKNESS_METRES)
        colours = np.clip(bilinear(views[n].picture(), views[n].places(points)) * gains[n], 0, 255).astype(np.float32)
        margin = min(1 / fineness, MAX_MARGIN_METRES)
        seen &= eyes.places[:, 2] > 0
        if not seen.any():
            continue
        across, shown = eyes.places[seen, :2], colours[seen]
        away = np.hypot(*(across - iris_centre(across, shown.mean(1))).T)
        iris.append(shown[(away > IRIS_BAND_METRES[0]) & (away < IRIS_BAND_METRES[1] - margin)])
        lit = shadow[seen] >= np.median(shadow[seen])
        white.append(shown[lit & (away > WHITE_BAND_METRES[0] + margin) & (away < WHITE_BAND_METRES[1])])
    return _middle(np.concatenate(iris)), _white(np.concatenate(white))


def _pupil(points: NDArray[np.floating], off: NDArray[np.float64]) -> NDArray[np.float64]:
    """(3,) the middle of those of the points (N, 3) that are the least `off` (N,) the axis of gaze."""
    return np.asarray(points[np.argsort(off)[: max(len(off) // 50, 1)]].mean(0))


def _pixels(view: FrameView, pupil: NDArray[np.float64], gaze: NDArray[np.float64]) -> float:
    """Pixels a metre that a frame has on an eye, seen from the front; 0 where it does not look into it."""
    back = np.array(view.camera.eye) - pupil
    cosine = float(back @ gaze / np.linalg.norm(back))
    x, y, away = view.camera.project(pupil[None])[0]
    height, width = view.camera.size
    if cosine < MIN_GAZE_COSINE or not (away > 0 and 0 <= x < width and 0 <= y < height):
        return 0.0
    return cosine * view.camera.focal / float(away)


def _middle(colours: NDArray[np.float32]) -> NDArray[np.float32]:
    if not len(colours):
        return colours
    lightness = to_lab(colours)[:, 0]
    low, high = np.quantile(lightness, IRIS_LIGHTNESS_QUANTILES)
    return colours[(lightness >= low) & (lightness <= high)]


def _white(colours: NDArray[np.float32]) -> NDArray[np.float32]:
    if not len(colours):
        return colours
    lab = to_lab(colours)
    low, high = np.quantile(lab[:, 0], WHITE_LIGHTNESS_QUANTILES)
    return colours[(lab[:, 0] >= low) & (lab[:, 0] <= high) & (np.hypot(lab[:, 1], lab[:, 2]) < MAX_WHITE_CHROMA)]
