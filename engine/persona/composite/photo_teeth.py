"""The upper teeth of one photograph of the person, in a mouth of theirs that moves.

Teeth that are averaged over photographs are ghosts, and a driver's are somebody else's. One photograph's are sharp; they sit in the
skull, and lips uncover them: they are neither drawn wide nor long with the mouth. Below them is the dark of the mouth.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.hidden_regions import (
    LOWER_INNER_LIP,
    LUMINANCE_WEIGHTS,
    UPPER_INNER_LIP,
    box_around,
    soft_polygon,
)
from engine.face_animation.mouth.teeth import draw_teeth, find_teeth
from engine.face_animation.target_face import TargetFace
from engine.imaging.resample import resized
from engine.perception.expression.features import frontalise
from engine.perception.landmarks import FACE_OVAL, LIPS_INNER, LIPS_OUTER, eye_distance, mouth_opening
from engine.persona.collection.face_photo import FacePhoto
from engine.persona.composite.skin_colour import is_grey, skin_colour
from engine.persona.composite.skull import skull_camera

APPEARING_OPENING, FULL_OPENING = 0.03, 0.09
"""Of the mouth, beyond that of the picture's, between which the inside appears."""
REST_FACTOR = 1.15
"""Of a picture's own opening, up to which its own inside is shown."""
NOSE_BASE = (2, 94, 98, 327)
"""What the teeth sit under."""
BEHIND_LIPS = 0.03
"""Eye distances by which teeth lie behind the inner lips."""
MAX_ENLARGEMENT = 1.25
WIDE_PERCENTILE = 80
"""Of the open mouths' widths, that teeth fill."""
MAX_LIFT = 0.12
"""Eye distances by which teeth are put higher than noses say."""
LIP_SHADOW = 0.02
"""Eye distances below the photograph's upper lip from which on teeth are taken: above are the lip and its edge."""
BRIGHT_PERCENTILE, TEETH_PERCENTILE = 95, 90
"""Of the face's light and of that of the teeth: these are no brighter."""
TONGUE_GAPS = (0.1, 0.3)
"""Widths of the mouth by which lips are apart where the tongue begins to be seen, and is wholly."""
TONGUE_TOP = 0.45
"""Of the way from lip to lip, from which on down it is."""
TONGUE_LIGHT = 0.7
TONGUE_SHARE = 0.5
"""Of the lips' light, that is the tongue's."""
ARCH, ARCH_ROUNDS = 1.2, 3
"""Eye distances by which teeth lie further back, for the square of one to the side; and how often it is asked where that is."""
LIP_SHADE, LIP_SHADE_WIDTH = 0.2, 0.12
"""Of the light, that the upper lip keeps from teeth at its edge, and widths of the mouth below it up to which it does."""
CORNER_SHADE, CORNER_SHADE_WIDTH = 0.35, 0.25
GAIN_RANGE = (0.5, 1.7)
MARGIN = 0.1
"""Eye distances around the photograph's lips that are kept."""
SOFTNESS = 0.012
"""Eye distances over which the teeth pass into the dark."""
MAX_SHARPENING = 1.2
"""Of what is finer than a pixel, where the photograph is enlarged twice or more: its own pixels have blurred it."""
CORNERS = (78, 308)
UPPER_MIDDLE = (13, 82, 312)


class PhotoTeeth:
    """`MouthInterior` of a person: the teeth of one photograph over the dark of the mouth, in the light of the `target`.

    `cavity` (3,) sRGB, the dark of their mouth. `faces` (F, 478, 2) what the target's face does: its teeth are put as high as lets the
    photograph's lip cover none of what the target's uncovers, and stay there.
    """

    def __init__(self, target: TargetFace, photo: FacePhoto, cavity: NDArray[np.floating], faces: NDArray[np.floating]):
        self._own = find_teeth(target.rgb, target.mesh)
        self._appearing = max(APPEARING_OPENING, REST_FACTOR * float(mouth_opening(target.mesh)))
        self._front = frontalise(target.mesh[None])[0]
        self._source = _Source.of(photo, float(eye_distance(target.mesh[:, :2])))
        self._depth = float(self._front[list(UPPER_MIDDLE), 2].mean()) + BEHIND_LIPS
        self._gain = _gain(target, photo)
        self._grey = is_grey(target.rgb, target.mesh)
        self._gain *= min(1.0, _brightest(target) / self._source.brightest(self._gain))
        self._open = faces[np.asarray(mouth_opening(faces)) > FULL_OPENING]
        self._enlarged = self._enlargement()
        self._shift = self._under_the_nose()
        self._tongue = (TONGUE_SHARE * _lips(target)).astype(np.float32)
        self._cavity = np.asarray(cavity, np.float32) * np.clip(self._gain, GAIN_RANGE[0], 1.2)

    def draw(self, frame: NDArray[np.uint8], face: NDArray[np.float32], driver_frame: int) -> None:
        """As `MouthInterior.draw`."""
        opening = float(mouth_opening(face))
        share = float(np.clip((opening - self._appearing) / (FULL_OPENING - APPEARING_OPENING), 0, 1))
        if self._own is not None:
            draw_teeth(frame, self._own, face, 1 - share)
        inner = face[list(LIPS_INNER), :2].astype(np.float32)
        box = box_around(inner, frame.shape[:2])
        if share == 0 or box is None:
            return
        x0, y0, x1, y1 = box
        corner = np.array([x0, y0], np.float32)
        colours = self.inside(face, corner, (y1 - y0, x1 - x0))
        mask = share * soft_polygon(inner - corner, (y1 - y0, x1 - x0))[..., None]
        part = frame[y0:y1, x0:x1]
        part[:] = np.clip(part + mask * (colours - part) + 0.5, 0, 255).astype(np.uint8)

    def inside(
        self, face: NDArray[np.floating], corner: NDArray[np.floating], shape: tuple[int, int]
    ) -> NDArray[np.float32]:
        """(h, w, 3) what is behind the lips of a `face` (478, 2), in a part of `shape` (h, w) of its picture whose first pixel is
        at `corner` (2,)."""
        at = self.origins(face, corner, shape)
        found = cv2.remap(self._source.layer, at[..., 0], at[..., 1], cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
        layer = np.clip(np.asarray(found, np.float32), 0, (255, 255, 255, 1))
        teeth = layer[..., :3] * self._gain * self._shade(face, corner, shape)[..., None]
        behind = self._cavity + self._tongue_share(face, corner, shape)[..., None] * (self._tongue - self._cavity)
        mixed = behind + layer[..., 3:] * (teeth - behind)
        if self._grey:
            mixed = np.repeat((mixed @ LUMINANCE_WEIGHTS)[..., None], 3, axis=-1)
        return np.asarray(mixed, np.float32)

    def _shade(
        self, face: NDArray[np.floating], corner: NDArray[np.floating], shape: tuple[int, int]
    ) -> NDArray[np.float32]:
        """(h, w) of the light that reaches teeth: less below the upper lip, and in the mouth's corners."""
        along, under, _ = _in_mouth(face, corner, shape)
        corners = np.clip(np.minimum(along, 1 - along) / CORNER_SHADE_WIDTH, 0, 1)
        lips = np.clip(under / LIP_SHADE_WIDTH, 0, 1)
        return np.asarray((1 - LIP_SHADE * (1 - lips) ** 2) * (1 - CORNER_SHADE * (1 - corners) ** 2), np.float32)

    def _tongue_share(
        self, face: NDArray[np.floating], corner: NDArray[np.floating], shape: tuple[int, int]
    ) -> NDArray[np.float32]:
        """(h, w) how much of the tongue is seen: it rises behind the lower lip, the more the wider the mouth is open."""
        along, under, above = _in_mouth(face, corner, shape)
        height = np.maximum(under + above, 1e-6)
        open_wide = np.clip((height - TONGUE_GAPS[0]) / (TONGUE_GAPS[1] - TONGUE_GAPS[0]), 0, 1)
        rise = np.clip((under / height - TONGUE_TOP) / (1 - TONGUE_TOP), 0, 1)
        across = np.clip(1 - (2 * along - 1) ** 2, 0, 1)
        return np.asarray(TONGUE_LIGHT * open_wide * across * rise * rise * (3 - 2 * rise), np.float32)

    def origins(
        self, face: NDArray[np.floating], corner: NDArray[np.floating], shape: tuple[int, int]
    ) -> NDArray[np.float32]:
        """(h, w, 2) where in the kept part of the photograph the teeth of each pixel are: through both skulls, and no further up
        than its lip."""
        source = self._source
        matrix, shift = skull_camera(self._front, face)
        rows, columns = np.mgrid[: shape[0], : shape[1]].astype(np.float64)
        seen = np.stack([columns, rows], axis=-1) + corner - shift
        back = np.linalg.inv(matrix[:, :2]).T
        lip = source.front[list(UPPER_INNER_LIP), :2]
        middle = float(source.front[list(CORNERS), 0].mean())
        top = float(source.front[list(UPPER_MIDDLE), 1].mean())
        depth = np.full(shape, self._depth)
        for _ in range(ARCH_ROUNDS):  # the arch of the teeth goes back to both sides
            front = (seen - depth[..., None] * matrix[:, 2]) @ back + self._shift[:2]
            depth = self._depth + ARCH * (front[..., 0] - middle) ** 2
        x = middle + (front[..., 0] - middle) / self._enlarged
        y = top + (front[..., 1] - top) / self._enlarged
        y = np.maximum(y, np.interp(x, lip[:, 0], lip[:, 1]) + LIP_SHADOW)
        return source.places(np.stack([x, y], axis=-1), depth + self._shift[2])

    def _enlargement(self) -> float:
        """By which teeth are larger than the photograph has them, so that they fill mouths that are wider; the same all the time."""
        if not len(self._open):
            return 1.0
        own = float(np.linalg.norm(np.diff(self._source.front[list(CORNERS)], axis=0)))
        wide = [
            np.linalg.norm(face[CORNERS[0]] - face[CORNERS[1]]) / np.linalg.norm(skull_camera(self._front, face)[0][0])
            for face in self._open
        ]
        return float(np.clip(np.percentile(wide, WIDE_PERCENTILE) / own, 1, MAX_ENLARGEMENT))

    def _under_the_nose(self) -> NDArray[np.float64]:
        """(3,) from the target's face in front view to the photograph's: the noses' bases at one height and the mouths' middles on
        one another, and no bare gap below the lip of any open mouth."""
        shift = (self._source.front[list(NOSE_BASE)] - self._front[list(NOSE_BASE)]).mean(axis=0)
        shift[0] = (self._source.front[list(CORNERS), 0] - self._front[list(CORNERS), 0]).mean()
        own = self._source.front[list(UPPER_MIDDLE), 1].mean()
        highest = own
        for face in self._open:
            matrix, start = skull_camera(self._front, face)
            lip = np.linalg.solve(
                matrix[:, :2], face[list(UPPER_MIDDLE)].mean(axis=0) - start - self._depth * matrix[:, 2]
            )
            highest = min(highest, lip[1] + shift[1])
        return shift + np.array([0, min(own - highest, MAX_LIFT), 0])


def _in_mouth(
    face: NDArray[np.floating], corner: NDArray[np.floating], shape: tuple[int, int]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """(h, w) each: where a pixel is along the mouth, from 0 to 1, and how far below the upper inner lip and above the lower one,
    in widths of the mouth."""
    right, left = face[CORNERS[0], :2], face[CORNERS[1], :2]
    width = max(float(np.linalg.norm(left - right)), 1.0)
    axis = (left - right) / width
    down = np.array([-axis[1], axis[0]])
    rows, columns = np.mgrid[: shape[0], : shape[1]]
    seen = np.stack([columns, rows], axis=-1) + corner - right
    along, height = seen @ axis / width, seen @ down / width
    upper, lower = (face[list(lip), :2] - right for lip in (UPPER_INNER_LIP, LOWER_INNER_LIP))
    top, bottom = (np.interp(along, lip @ axis / width, lip @ down / width) for lip in (upper, lower))
    return along, height - top, bottom - height


@dataclass(frozen=True)
class _Source:
    """layer : (h, w, 4) float32, the photograph's mouth, and in [0, 1] what of it is within the inner lips. front : (478, 3) its face
    turned to the front. matrix, shift : from there into the photograph; corner, scale : from there into the layer."""

    layer: NDArray[np.float32]
    front: NDArray[np.float64]
    matrix: NDArray[np.float64]
    shift: NDArray[np.float64]
    corner: NDArray[np.float64]
    scale: float

    @classmethod
    def of(cls, photo: FacePhoto, wanted: float) -> _Source:
        """Of a photograph, shrunk where its face is larger than one of an eye distance of `wanted` pixels asks for."""
        front = frontalise(photo.mesh[None])[0]
        unit = float(eye_distance(photo.mesh[:, :2]))
        low = np.floor(photo.mesh[list(LIPS_OUTER), :2].min(axis=0) - MARGIN * unit).astype(int).clip(0)
        high = np.ceil(photo.mesh[list(LIPS_OUTER), :2].max(axis=0) + MARGIN * unit).astype(int)
        part = photo.cut(low, np.minimum(high, photo.rgb.shape[1::-1]))
        scale = min(wanted / unit, 1.0)
        size = max(round(part.rgb.shape[1] * scale), 8), max(round(part.rgb.shape[0] * scale), 8)
        scale = size[0] / part.rgb.shape[1]
        small = resized(part.rgb, size).astype(np.float32)
        sharpness = MAX_SHARPENING * float(np.clip(wanted / unit - 1, 0, 1))
        small = np.clip(small + sharpness * (small - cv2.GaussianBlur(small, (0, 0), 1.0)), 0, 255)
        lips = (part.mesh[list(LIPS_INNER), :2] + 0.5) * scale - 0.5
        mask = cv2.GaussianBlur(
            soft_polygon(lips.astype(np.float32), size[::-1]), (0, 0), max(0.5, SOFTNESS * unit * scale)
        )
        matrix, shift = skull_camera(front, photo.mesh)
        return cls(np.dstack([small, np.asarray(mask)]), front, matrix, shift, low.astype(np.float64), scale)

    def brightest(self, gain: NDArray[np.floating]) -> float:
        """The luminance of the lightest teeth, each channel times its `gain` (3,)."""
        light = (self.layer[..., :3] * gain)[self.layer[..., 3] > 0.5] @ LUMINANCE_WEIGHTS
        return max(float(np.percentile(light, TEETH_PERCENTILE)), 1.0) if len(light) else 255.0

    def places(self, front: NDArray[np.floating], depth: NDArray[np.floating]) -> NDArray[np.float32]:
        """(..., 2) pixels of the layer for places (..., 2) of the face from the front at a `depth` (...)."""
        photo = front @ self.matrix[:, :2].T + depth[..., None] * self.matrix[:, 2] + self.shift
        return np.asarray((photo - self.corner + 0.5) * self.scale - 0.5, np.float32)


def _gain(target: TargetFace, photo: FacePhoto) -> NDArray[np.float32]:
    """(3,) by which the photograph's colours are brought into the target's light: all of the difference in brightness between
    the two skins, and half of that in colour, which is complexion and paint, too; none of it green."""
    ratio = skin_colour(target.rgb, target.mesh) / np.maximum(skin_colour(photo.rgb, photo.mesh), 1)
    brightness = float(ratio @ LUMINANCE_WEIGHTS)
    colour = np.sqrt(ratio / brightness)
    colour[1] = min(colour[1], max(colour[0], colour[2]))
    return np.asarray(np.clip(brightness, *GAIN_RANGE) * colour / float(colour @ LUMINANCE_WEIGHTS), np.float32)


def _lips(target: TargetFace) -> NDArray[np.float64]:
    """(3,) the mean colour of the target's lips."""
    mask = np.zeros(target.rgb.shape[:2], np.uint8)
    cv2.fillPoly(mask, [target.mesh[list(LIPS_OUTER), :2].round().astype(np.int32)], 1)
    cv2.fillPoly(mask, [target.mesh[list(LIPS_INNER), :2].round().astype(np.int32)], 0)
    return np.asarray(target.rgb[mask > 0].mean(axis=0) if mask.any() else (120.0, 70.0, 70.0))


def _brightest(target: TargetFace) -> float:
    """The luminance that teeth have at most: a light place's of the face."""
    mask = np.zeros(target.rgb.shape[:2], np.uint8)
    cv2.fillPoly(mask, [target.mesh[list(FACE_OVAL), :2].round().astype(np.int32)], 1)
    light = target.rgb[mask > 0].astype(np.float32) @ LUMINANCE_WEIGHTS
    return float(np.percentile(light, BRIGHT_PERCENTILE)) if len(light) else 255.0
