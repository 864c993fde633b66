"""Where lips meet that the picture shows parted: a dark line, as between any closed lips, which the picture does not have.

What the picture has there is a rest of its teeth, as narrow as landmarks are wrong.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.lip_contours import LOWER_INNER_LIP, UPPER_INNER_LIP, box_around
from engine.face_animation.mouth.mouth_interior import MouthInterior
from engine.face_animation.smoothstep import smoothstep
from engine.perception.face.landmarks import eye_distance, mouth_opening

MEETING_OPENINGS = (0.012, 0.05)
"""Openings of a mouth, its gap over its width, up to which its lips have met, and from which on they have not."""
SEAM_WIDTH_EYE_DISTANCES, SEAM_SOFTNESS_EYE_DISTANCES, MIN_SEAM_PIXELS = 0.03, 0.01, 0.8
"""Eye distances, of the line and of its edges, and pixels that either has at least."""
SEAM_LIGHT_SHARE = 0.42
"""Share of the lips' light that is left in the line between them."""
BARE_WIDTH_EYE_DISTANCES, MAX_LIP_LIGHT_RATIO = 0.1, 1.1
"""Eye distances around the line within which nothing is lighter than so many times the lips: the edges of teeth that the picture shows lie there, where landmarks
are wrong."""
WIDTH_SHARES = (0.2, 0.4, 0.7, 0.9, 1.0, 1.0, 1.0, 0.9, 0.7, 0.4, 0.2)
"""Of the line between lips, the shares of its width that it has from corner to corner."""


class LipSeam:
    """`MouthInterior` of parted lips: `inside`, and as they close a line in the lips' `colour` (3,), darkened, and nothing lighter than these beside it."""

    def __init__(self, inside: MouthInterior, colour: NDArray[np.floating]):
        self.inside, self._lips = inside, np.asarray(colour, np.float32)

    def draw(self, frame: NDArray[np.uint8], face: NDArray[np.float32], driver_frame: int) -> None:
        """As `MouthInterior.draw`."""
        share = met_share(float(mouth_opening(face)))
        if share < 1:
            self.inside.draw(frame, face, driver_frame)
        unit = float(eye_distance(face))
        width, soft, bare = (
            max(one * unit, MIN_SEAM_PIXELS)
            for one in (SEAM_WIDTH_EYE_DISTANCES, SEAM_SOFTNESS_EYE_DISTANCES, BARE_WIDTH_EYE_DISTANCES)
        )
        outline = seam(face, bare).astype(np.float32)
        box = box_around(outline, frame.shape[:2])
        if share == 0 or box is None:
            return
        x0, y0, x1, y1 = box
        part = frame[y0:y1, x0:x1]
        seen = part.astype(np.float32)
        seen += (
            share
            * _soft(outline - (x0, y0), soft, part.shape[:2])
            * (np.minimum(seen, MAX_LIP_LIGHT_RATIO * self._lips) - seen)
        )
        line = _soft(seam(face, width) - (x0, y0), soft, part.shape[:2])
        part[:] = np.clip(seen + share * line * (SEAM_LIGHT_SHARE * self._lips - seen) + 0.5, 0, 255).astype(np.uint8)


def _soft(outline: NDArray[np.floating], soft: float, shape: tuple[int, ...]) -> NDArray[np.float32]:
    """(h, w, 1) the coverage of an outline (P, 2), blurred by `soft` pixels."""
    mask = np.zeros(shape, np.uint8)
    cv2.fillPoly(mask, [np.round(16 * outline).astype(np.int32)], 255, cv2.LINE_AA, 4)
    return np.asarray(cv2.GaussianBlur(mask.astype(np.float32) / 255, (0, 0), soft), np.float32)[..., None]


def met_share(opening: float) -> float:
    """How far the lips of a mouth of this opening have met."""
    return 1 - float(smoothstep(opening, *MEETING_OPENINGS))


def seam(face: NDArray[np.floating], width: float) -> NDArray[np.float64]:
    """(22, 2) the outline of the line between the lips of a face (478, 2), pixels: what is left of their gap, and `width` at least."""
    upper, lower = face[list(UPPER_INNER_LIP), :2].astype(float), face[list(LOWER_INNER_LIP), :2].astype(float)
    middle, half = (upper + lower) / 2, np.linalg.norm(lower - upper, axis=1) / 2
    across = middle[-1] - middle[0]
    down = np.array([-across[1], across[0]]) / max(float(np.linalg.norm(across)), 1e-6)
    reach = np.maximum(half, np.array(WIDTH_SHARES) * width / 2)[:, None] * down
    return np.concatenate([middle - reach, (middle + reach)[::-1]])
