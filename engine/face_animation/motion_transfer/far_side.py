"""The far side of a head that turns: the cheek passes before ear and hair, and hides them; a jaw passes before the neck.

Carried by one sheet, what lies between the face's contour and the outline of the head would be squeezed to a strip: an ear as thin as a line. So where
the face goes out over what lies beside it, the picture has a second sheet behind the face, on which that keeps its width; the face is drawn over
it. Along the contour both go together, and elsewhere they are one, since cheek, ear and hair hang together.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.contour import outward
from engine.face_animation.motion_transfer.head_proxy import beside_rim
from engine.perception.face.landmarks import FACE_OVAL

COVERING_WEIGHTS = np.interp(np.arange(len(FACE_OVAL)), (5, 7, 29, 31), (0, 1, 1, 0))
"""How far each vertex of `FACE_OVAL` may pass before what lies beside it: not the forehead, where hair grows."""


class FarSide:
    """What a face (478, 2 or 3) covers of control points (C, 2), those of the face first."""

    def __init__(self, mesh: NDArray[np.floating], points: NDArray[np.floating]):
        self._beside = beside_rim(mesh, points)
        self._share = self._beside @ COVERING_WEIGHTS

    def withdrawn(self, carried: NDArray[np.floating], skull: NDArray[np.floating]) -> NDArray[np.float64]:
        """(N, C, 2) how far the sheet behind the face lies inwards of the face's own, pixels.

        Parameters
        ----------
        carried : (N, C, 2) where the face's sheet carries the points. skull : (N, C, 2) where they would go without the face, with the
        outline of the head and with the body.
        """
        out = self._beside @ outward(skull[:, list(FACE_OVAL)])
        out /= np.maximum(np.linalg.norm(out, axis=2, keepdims=True), 1e-6)
        beyond = np.maximum(((carried - skull) * out).sum(axis=2), 0)
        return np.asarray(-(self._share * beyond)[..., None] * out)
