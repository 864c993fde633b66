"""The upper teeth of one photograph of the person, in a mouth of theirs that moves.

Teeth that are averaged over photographs are ghosts, and a driver's are somebody else's. One photograph's are sharp; they sit in the
skull, and lips uncover them: they are neither drawn wide nor long with the mouth. What is below them, lower teeth, tongue and the dark, no
photograph shows as a mouth that moves has them: these are the driver's, by which nobody is known.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.lip_contours import box_around, inner_lip_outline, soft_polygon
from engine.face_animation.mouth.modelled.modelled_mouth import (
    ALL_TEETH,
    LIP_SOFTNESS_EYE_DISTANCES,
    MIN_LIP_SOFTNESS_PIXELS,
    covered_crown,
    hidden_crown,
    shown_share,
    shown_teeth,
    stubs,
)
from engine.face_animation.mouth.modelled.mouth_colours import mouth_albedo
from engine.face_animation.mouth.modelled.mouth_light import mouth_light
from engine.face_animation.mouth.modelled.resting_mouth import (
    MIN_FULL_OPENING,
    UPPER_LIP_MIDDLE_VERTICES,
    RestingMouth,
)
from engine.face_animation.mouth.modelled.skull import from_before, skull_camera
from engine.face_animation.mouth.mouth_interior import MouthInterior
from engine.face_animation.mouth.pictured.pictured_face import PicturedFace
from engine.face_animation.mouth.pictured.teeth_strip import ARCH_CURVATURE_PER_EYE_DISTANCE, TeethStrip, teeth_strip
from engine.face_animation.skin_colour import face_luminance, is_grey, skin_colour
from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.perception.face.landmarks import (
    INNER_MOUTH_CORNER_VERTICES,
    INNER_UPPER_LIP_VERTEX,
    eye_distance,
    mouth_opening,
)

APPEARING_OPENING = 0.015
"""Of the mouth, from which on the inside appears."""
OWN_INSIDE_OPENING_RATIO = 1.15
"""Of a picture's own opening, up to which its own inside is shown."""
MAX_TEETH_WIDTH_RATIO, MAX_TEETH_LENGTH_RATIO = 1.25, 1.35
"""By how many times teeth may be wider and longer than in the photograph, so that they fill mouths that are wider, and
reach up to lips that are higher."""
MOUTH_SIZE_PERCENTILE = 80
"""Of the open mouths' widths and lips' heights, that teeth fill."""
ARCH_ROUNDS = 3
"""How often it is asked how far back the teeth are that a pixel shows."""
FACE_LIGHT_PERCENTILE = 97
"""Of the face's light: teeth are no brighter."""
MIN_PHOTO_TEETH_TO_SKIN_RATIO = 1.1
"""How many times as light as the skin beside them a photograph's teeth are, at least."""
TEETH_GAIN_RANGE = (0.5, 1.7)


class PhotoTeeth:
    """`MouthInterior` of a person: the upper teeth of one `photo`, in the light of a picture `rgb` (H, W, 3) of their face at `mesh` (478, 3),
    before what is `behind` them. `at` : how the face rests.

    `faces` (F, 478, 2) what the face does: what of its teeth that uncovers is as wide and long as the teeth are made, once. `appearing` :
    the opening from which on they are seen. `shown` : (N, 2) as of `ModelledMouth`.
    """

    def __init__(
        self,
        at: RestingMouth,
        rgb: NDArray[np.uint8],
        mesh: NDArray[np.floating],
        photo: PicturedFace,
        behind: MouthInterior,
        faces: NDArray[np.floating],
        appearing: float = 0.0,
        shown: NDArray[np.floating] | None = None,
    ):
        self._shown = shown
        self.at, self._behind = at, behind
        self._appearing = appearing
        self._strip = teeth_strip(photo, float(eye_distance(mesh[:, :2])))
        self._wider, self._longer = self._size(faces[np.asarray(mouth_opening(faces)) > MIN_FULL_OPENING])
        self._gain = teeth_gain(rgb, mesh, photo, self._strip)
        self._grey, self._albedo = is_grey(rgb, mesh), mouth_albedo(rgb, mesh)

    def draw(self, frame: NDArray[np.uint8], face: NDArray[np.float32], driver_frame: int) -> None:
        """As `MouthInterior.draw`."""
        self._behind.draw(frame, face, driver_frame)
        share = shown_share(face, self._appearing)
        inner = inner_lip_outline(face)
        box = box_around(inner, frame.shape[:2])
        if share == 0 or box is None:
            return
        x0, y0, x1, y1 = box
        corner = np.array([x0, y0], np.float32)
        teeth = self.teeth(face, corner, (y1 - y0, x1 - x0), shown_teeth(self._shown, driver_frame)[0])
        sigma = max(MIN_LIP_SOFTNESS_PIXELS, LIP_SOFTNESS_EYE_DISTANCES * float(eye_distance(face)))
        mask = cv2.GaussianBlur(soft_polygon(inner - corner, (y1 - y0, x1 - x0)), (0, 0), sigma)[..., None]
        part = frame[y0:y1, x0:x1]
        covered = share * np.asarray(mask) * teeth[..., 3:]
        part[:] = np.clip(part + covered * (teeth[..., :3] - part) + 0.5, 0, 255).astype(np.uint8)

    def teeth(
        self,
        face: NDArray[np.floating],
        corner: NDArray[np.floating],
        shape: tuple[int, int],
        shown: float = ALL_TEETH[0],
    ) -> NDArray[np.float32]:
        """(h, w, 4) the teeth's colours in the target's light, and their shares, in a part of `shape` (h, w) of the picture of a `face`
        (478, 2) whose first pixel is at `corner` (2,)."""
        layer = self.upper_teeth(self.places(face, corner, shape, shown))
        layer[..., :3] = self.lit(layer[..., :3]) * mouth_light(face, corner, shape, self._albedo)
        return layer

    def lit(self, colours: NDArray[np.float32]) -> NDArray[np.float32]:
        """(..., 3) colours of the photograph's teeth in the light of the picture."""
        lit = colours * self._gain
        if self._grey:
            lit[:] = (lit @ LUMINANCE_WEIGHTS)[..., None]
        return np.asarray(lit, np.float32)

    def places(
        self,
        face: NDArray[np.floating],
        corner: NDArray[np.floating],
        shape: tuple[int, int],
        shown: float = ALL_TEETH[0],
    ) -> NDArray[np.float64]:
        """(h, w, 2) where on the arch of the teeth each pixel is, as the target's skull has it from the front, in eye distances from
        the middle of where the upper teeth end. Lips that are rounded are before them: they end higher by what those cover, and
        by what is beyond the share `shown` of the opening."""
        matrix, shift = skull_camera(self.at.front, face)
        front = from_before(self.at.front, face, matrix, shift)
        covered = covered_crown(self.at, front)
        seen = self.at.edge - covered - float(front[INNER_UPPER_LIP_VERTEX, 1])
        hidden = hidden_crown(seen, front, shown)
        covered += hidden + (ALL_TEETH[0] - shown) * stubs(seen - hidden)
        back = np.linalg.inv(matrix[:, :2]).T
        rows, columns = np.ogrid[: shape[0], : shape[1]]
        across, down = columns + (corner[0] - shift[0]), rows + (corner[1] - shift[1])
        further = matrix[:, 2] @ back  # by how much a place is moved for each eye distance that it is further back
        x0 = across * back[0, 0] + down * back[1, 0] - self.at.depth * further[0] - self.at.middle
        y0 = across * back[0, 1] + down * back[1, 1] - self.at.depth * further[1] - self.at.edge + covered
        x = x0
        for _ in range(ARCH_ROUNDS - 1):  # the arch goes back to both sides
            x = x0 - ARCH_CURVATURE_PER_EYE_DISTANCE * further[0] * x**2
        arch = ARCH_CURVATURE_PER_EYE_DISTANCE * x**2
        return np.stack([x0 - arch * further[0], y0 - arch * further[1]], axis=-1)

    def upper_teeth(self, places: NDArray[np.floating]) -> NDArray[np.float32]:
        """(h, w, 4) colours as in the photograph, and shares, at `places` as those of the same name."""
        x = self._strip.middle + places[..., 0] / self._wider
        middle = np.full((), self._strip.middle)
        return self._strip.sampled(x, self._strip.ends(middle) + places[..., 1] / self._longer)

    def _size(self, faces: NDArray[np.floating]) -> tuple[float, float]:
        """How much wider and longer than in the photograph teeth are, for open mouths (F, 478, 2)."""
        if not len(faces):
            return 1.0, 1.0
        widths, heights = [], []
        for face in faces:
            matrix, shift = skull_camera(self.at.front, face)
            widths.append(
                np.linalg.norm(face[INNER_MOUTH_CORNER_VERTICES[0]] - face[INNER_MOUTH_CORNER_VERTICES[1]])
                / np.linalg.norm(matrix[0])
            )
            lip = face[list(UPPER_LIP_MIDDLE_VERTICES)].mean(axis=0) - shift - self.at.depth * matrix[:, 2]
            heights.append(self.at.edge - np.linalg.solve(matrix[:, :2], lip)[1])
        middle = np.full((), self._strip.middle)
        own = float(self._strip.ends(middle) - self._strip.lip(middle))
        wide, high = (float(np.percentile(one, MOUTH_SIZE_PERCENTILE)) for one in (widths, heights))
        wider = float(np.clip(wide / self._strip.width, 1, MAX_TEETH_WIDTH_RATIO))
        return wider, float(np.clip(high / own, 1, MAX_TEETH_LENGTH_RATIO))


def appearing_opening(mesh: NDArray[np.floating]) -> float:
    """The opening of a mouth from which on its inside is drawn: up to there the picture's own is seen, whose face is at `mesh`
    (478, 2 or 3)."""
    return max(APPEARING_OPENING, OWN_INSIDE_OPENING_RATIO * float(mouth_opening(mesh)))


def teeth_gain(
    rgb: NDArray[np.uint8], mesh: NDArray[np.floating], photo: PicturedFace, strip: TeethStrip
) -> NDArray[np.float32]:
    """(3,) by which the colours of the `strip` of a photograph's teeth are brought into the light of a picture `rgb` (H, W, 3) of the same
    face at `mesh` (478, 3)."""
    gain = _gain(rgb, mesh, photo)
    return np.asarray(gain * _held(strip.brightest(gain), rgb, mesh), np.float32)


def _gain(rgb: NDArray[np.uint8], mesh: NDArray[np.floating], photo: PicturedFace) -> NDArray[np.float32]:
    """(3,) all of the difference in brightness between the two skins, and half of that in colour, which is complexion and paint, too; none
    of it green."""
    ratio = skin_colour(rgb, mesh) / np.maximum(skin_colour(photo.rgb, photo.mesh), 1)
    brightness = float(ratio @ LUMINANCE_WEIGHTS)
    colour = np.sqrt(ratio / brightness)
    colour[1] = min(colour[1], max(colour[0], colour[2]))
    return np.asarray(np.clip(brightness, *TEETH_GAIN_RANGE) * colour / float(colour @ LUMINANCE_WEIGHTS), np.float32)


def _held(brightest: float, rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> float:
    """The factor that keeps teeth whose lightest have the luminance `brightest` between what the skin beside them has, and somewhat more, and
    what a light place of the face has."""
    light = face_luminance(rgb, mesh)
    most = float(np.percentile(light, FACE_LIGHT_PERCENTILE)) if len(light) else 255.0
    least = MIN_PHOTO_TEETH_TO_SKIN_RATIO * float(skin_colour(rgb, mesh) @ LUMINANCE_WEIGHTS)
    return float(np.clip(brightest, min(least, most), most)) / brightest
