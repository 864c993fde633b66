"""The teeth of one photograph of the person, in a mouth of theirs that moves.

Teeth that are averaged over photographs are ghosts, and a driver's are somebody else's. One photograph's are sharp; they sit in the
skull, and lips uncover them: they are neither drawn wide nor long with the mouth. The lower ones are the upper ones turned over, and go
with the jaw. Behind both are the dark of the mouth, and the tongue.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.hidden_regions import LUMINANCE_WEIGHTS, box_around, soft_polygon
from engine.face_animation.mouth.teeth import draw_teeth, find_teeth
from engine.face_animation.target_face import TargetFace
from engine.perception.expression.features import frontalise
from engine.perception.landmarks import FACE_OVAL, LIPS_INNER, LIPS_OUTER, eye_distance, mouth_opening
from engine.persona.collection.face_photo import FacePhoto
from engine.persona.composite.mouth_light import in_mouth
from engine.persona.composite.skin_colour import is_grey, skin_colour
from engine.persona.composite.skull import skull_camera
from engine.persona.composite.teeth_strip import ARCH, BEHIND_LIPS, CORNERS, teeth_strip

APPEARING_OPENING, FULL_OPENING = 0.03, 0.09
"""Of the mouth, beyond that of the picture's, between which the inside appears."""
REST_FACTOR = 1.15
"""Of a picture's own opening, up to which its own inside is shown."""
NOSE_BASE = (2, 94, 98, 327)
CHIN = (148, 152, 377)
UPPER_MIDDLE = (82, 13, 312)
SHUT_OPENING = 0.05
"""Of a mouth that tells where its lips meet."""
BELOW_LIPS = 0.06
"""Eye distances below where the lips meet, at which upper teeth end."""
EDGE_SOFTNESS = 0.02
"""Eye distances over which lower teeth begin."""
MAX_WIDER, MAX_LONGER = 1.25, 1.35
"""Than in the photograph: so that teeth fill mouths that are wider, and reach up to lips that are higher."""
WIDE_PERCENTILE = 80
"""Of the open mouths' widths and lips' heights, that teeth fill."""
ROUND = 0.85
"""Of the width of a shut mouth, that a round one has."""
LOWER_SIZE = 0.8
"""Of the lower teeth, in that of the upper ones."""
LOWER_LIGHT = np.array([0.76, 0.67, 0.63], np.float32)
"""Of red, green and blue that reaches them: between gums, tongue and lips it is dim and red."""
GUM_SOFTNESS = 0.04
"""Eye distances above their roots over which they pass into what is behind."""
ARCH_ROUNDS = 3
"""How often it is asked how far back the teeth are that a pixel shows."""
BRIGHT_PERCENTILE = 97
"""Of the face's light: teeth are no brighter."""
LIGHTER_THAN_SKIN = 1.1
"""Teeth are than the skin beside them, at least."""
TONGUE_SHARE = 0.5
"""Of the lips' light, that is the tongue's."""
GAIN_RANGE = (0.5, 1.7)
LIP_SOFTNESS, LEAST_SOFT_PIXELS = 0.012, 0.8
"""Eye distances, and pixels, over which the inside passes into the lips: their edges are round, and the mesh's have corners."""


class PhotoTeeth:
    """`MouthInterior` of a person: the teeth of one photograph over the dark of the mouth, in the light of the `target`.

    `cavity` (3,) sRGB, the dark of their mouth. `neutral` (478, 3) their face at rest from the front, in eye distances. `faces`
    (F, 478, 2) what the target's face does: what of its teeth that uncovers is as wide and long as the teeth are made, once.
    """

    def __init__(
        self,
        target: TargetFace,
        photo: FacePhoto,
        cavity: NDArray[np.floating],
        neutral: NDArray[np.floating],
        faces: NDArray[np.floating],
    ):
        rest = float(mouth_opening(target.mesh))
        self._own = find_teeth(target.rgb, target.mesh)
        self._appearing = max(APPEARING_OPENING, REST_FACTOR * rest)
        self._front = frontalise(target.mesh[None])[0]
        self._shut = self._front if rest < SHUT_OPENING else _laid_on(neutral, self._front)
        self._depth = float(self._front[list(UPPER_MIDDLE), 2].mean()) + BEHIND_LIPS
        self._middle = float(self._front[list(CORNERS), 0].mean())
        self._edge = float(self._shut[[13, 14], 1].mean()) + BELOW_LIPS
        self._strip = teeth_strip(photo, float(eye_distance(target.mesh[:, :2])))
        self._wider, self._longer = self._size(faces[np.asarray(mouth_opening(faces)) > FULL_OPENING])
        self._gain = _gain(target, photo)
        self._gain *= _held(self._strip.brightest(self._gain), target)
        self._grey = is_grey(target.rgb, target.mesh)
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
        sigma = max(LEAST_SOFT_PIXELS, LIP_SOFTNESS * float(eye_distance(face)))
        mask = share * cv2.GaussianBlur(soft_polygon(inner - corner, (y1 - y0, x1 - x0)), (0, 0), sigma)[..., None]
        part = frame[y0:y1, x0:x1]
        part[:] = np.clip(part + mask * (colours - part) + 0.5, 0, 255).astype(np.uint8)

    def inside(
        self, face: NDArray[np.floating], corner: NDArray[np.floating], shape: tuple[int, int]
    ) -> NDArray[np.float32]:
        """(h, w, 3) what is behind the lips of a `face` (478, 2), in a part of `shape` (h, w) of its picture whose first pixel is
        at `corner` (2,)."""
        place, behind = in_mouth(face, corner, shape), self.places(face, corner, shape)
        light = place.light()[..., None]
        mixed: NDArray[np.float32] = self._cavity + place.tongue()[..., None] * (self._tongue - self._cavity)
        lower, upper = self.lower_teeth(behind, self.jaw_drop(face)), self.upper_teeth(behind)
        lower[..., 3] *= self._spread(face)
        for teeth, lit in ((lower, light * LOWER_LIGHT), (upper, light)):
            mixed += teeth[..., 3:] * (teeth[..., :3] * self._gain * lit - mixed)
        if self._grey:
            mixed[:] = (mixed @ LUMINANCE_WEIGHTS)[..., None]
        return mixed

    def places(
        self, face: NDArray[np.floating], corner: NDArray[np.floating], shape: tuple[int, int]
    ) -> NDArray[np.float64]:
        """(h, w, 2) where on the arch of the teeth each pixel is, as the target's skull has it from the front, in eye distances from
        the middle of where the upper teeth end."""
        matrix, shift = skull_camera(self._front, face)
        rows, columns = np.mgrid[: shape[0], : shape[1]].astype(np.float64)
        seen = np.stack([columns, rows], axis=-1) + corner - shift
        back = np.linalg.inv(matrix[:, :2]).T
        depth = np.full(shape, self._depth)
        for _ in range(ARCH_ROUNDS):  # the arch goes back to both sides
            front = (seen - depth[..., None] * matrix[:, 2]) @ back - (self._middle, self._edge)
            depth = self._depth + ARCH * front[..., 0] ** 2
        return np.asarray(front, np.float64)

    def upper_teeth(self, places: NDArray[np.floating]) -> NDArray[np.float32]:
        """(h, w, 4) colours as in the photograph, and shares, at `places` as those of the same name."""
        x = self._strip.middle + places[..., 0] / self._wider
        middle = np.full((), self._strip.middle)
        return self._strip.sampled(x, self._strip.ends(middle) + places[..., 1] / self._longer)

    def lower_teeth(self, places: NDArray[np.floating], drop: float) -> NDArray[np.float32]:
        """As `upper_teeth`, where the jaw is `drop` eye distances lower than in a shut mouth."""
        x = self._strip.middle + places[..., 0] / (LOWER_SIZE * self._wider)
        down = (places[..., 1] - drop) / LOWER_SIZE
        left = self._strip.ends(x) - self._strip.lip(x) - down
        layer = self._strip.sampled(x, self._strip.lip(x) + left)
        layer[..., 3] *= np.clip(down / EDGE_SOFTNESS + 0.5, 0, 1) * np.clip(left / GUM_SOFTNESS, 0, 1)
        return layer

    def jaw_drop(self, face: NDArray[np.floating]) -> float:
        """Eye distances by which the chin of a `face` (478, 2) is lower than in a shut mouth."""
        matrix, shift = skull_camera(self._front, face)
        chin = self._shut[list(CHIN)].mean(axis=0)
        seen = face[list(CHIN), :2].mean(axis=0) - shift - chin[2] * matrix[:, 2]
        return max(float(np.linalg.solve(matrix[:, :2], seen)[1] - chin[1]), 0.0)

    def _spread(self, face: NDArray[np.floating]) -> np.float32:
        """In [0, 1], how far a mouth is from a round one, whose lips cover the lower teeth."""
        now = np.linalg.norm(face[CORNERS[0], :2] - face[CORNERS[1], :2]) / np.linalg.norm(
            skull_camera(self._front, face)[0][0]
        )
        usual = np.linalg.norm(self._shut[CORNERS[0], :2] - self._shut[CORNERS[1], :2])
        return np.float32(np.clip((now / usual - ROUND) / (1 - ROUND), 0, 1))

    def _size(self, faces: NDArray[np.floating]) -> tuple[float, float]:
        """How much wider and longer than in the photograph teeth are, for open mouths (F, 478, 2)."""
        if not len(faces):
            return 1.0, 1.0
        widths, heights = [], []
        for face in faces:
            matrix, shift = skull_camera(self._front, face)
            widths.append(np.linalg.norm(face[CORNERS[0]] - face[CORNERS[1]]) / np.linalg.norm(matrix[0]))
            lip = face[list(UPPER_MIDDLE)].mean(axis=0) - shift - self._depth * matrix[:, 2]
            heights.append(self._edge - np.linalg.solve(matrix[:, :2], lip)[1])
        middle = np.full((), self._strip.middle)
        own = float(self._strip.ends(middle) - self._strip.lip(middle))
        wide, high = (float(np.percentile(one, WIDE_PERCENTILE)) for one in (widths, heights))
        wider = float(np.clip(wide / self._strip.width, 1, MAX_WIDER))
        return wider, float(np.clip(high / own, 1, MAX_LONGER))


def _laid_on(neutral: NDArray[np.floating], front: NDArray[np.floating]) -> NDArray[np.float64]:
    """(478, 3) a face at rest, its nose's base where the one that `front` (478, 3) has is."""
    base = list(NOSE_BASE)
    return np.asarray(neutral + (front[base] - neutral[base]).mean(axis=0), np.float64)


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


def _held(brightest: float, target: TargetFace) -> float:
    """The factor that keeps teeth whose lightest have the luminance `brightest` between what the skin beside them has, and somewhat more, and
    what a light place of the face has."""
    mask = np.zeros(target.rgb.shape[:2], np.uint8)
    cv2.fillPoly(mask, [target.mesh[list(FACE_OVAL), :2].round().astype(np.int32)], 1)
    light = target.rgb[mask > 0].astype(np.float32) @ LUMINANCE_WEIGHTS
    most = float(np.percentile(light, BRIGHT_PERCENTILE)) if len(light) else 255.0
    least = LIGHTER_THAN_SKIN * float(skin_colour(target.rgb, target.mesh) @ LUMINANCE_WEIGHTS)
    return float(np.clip(brightest, min(least, most), most)) / brightest
