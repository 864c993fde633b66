"""Spectacles before a face: their frame is one solid with the skull, and lids move behind it.

Brows that rise and cheeks that a smile lifts would bend the frame that the picture shows before them. Where it lies the skull alone carries the
picture; lids, and the brows above it, still act.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.lids_and_lips import LID_EDGE_VERTEX_PAIRS
from engine.face_animation.smoothstep import smoothstep
from engine.perception.face.face_wear import face_wear
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import LEFT_EYE, LEFT_IRIS, MESH_SIZE, RIGHT_EYE, RIGHT_IRIS

BRIDGE_STRENGTHS = (0.06, 0.1)
"""Of `FaceWear.bridge`, up to which there are no spectacles, and from which on there surely are: brows that meet over the nose have 0.07."""
UPPER_RIM_EYE_DISTANCES, LOWER_RIM_EYE_DISTANCES = (-0.4, -0.22), (0.6, 0.4)
"""Heights on a face between which it passes over into what lies behind a frame, from above and from below (`canonical_face`)."""
SKIN_BELOW_LIDS_VERTICES = (*(110, 24, 23, 22, 26), *(339, 254, 253, 252, 256))
"""Skin beside the lower lids' edges, which goes with them."""


def spectacles_share(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> NDArray[np.float64]:
    """(478,) how far each vertex of a face at `mesh` (478, 2 or 3), pixels of a picture (H, W, 3), lies behind the
    frame of spectacles. It is 0 of a face that wears none, or of which that cannot be told."""
    bridge = face_wear(rgb, mesh).bridge
    if not bridge > BRIDGE_STRENGTHS[0]:  # nor where it cannot be told, NaN
        return np.zeros(MESH_SIZE)
    share = smoothstep(bridge, *BRIDGE_STRENGTHS) * behind_frame()
    free = {
        *np.ravel(LID_EDGE_VERTEX_PAIRS),
        *RIGHT_EYE,
        *LEFT_EYE,
        *RIGHT_IRIS,
        *LEFT_IRIS,
        *SKIN_BELOW_LIDS_VERTICES,
    }
    share[sorted(int(vertex) for vertex in free)] = 0
    return share


def behind_frame() -> NDArray[np.float64]:
    """(478,) how far each vertex of a face that wears spectacles lies behind them, lenses and all."""
    height = canonical_face()[:, 1].astype(float)
    return np.asarray(
        smoothstep(height, *UPPER_RIM_EYE_DISTANCES) * smoothstep(height, *LOWER_RIM_EYE_DISTANCES), float
    )
