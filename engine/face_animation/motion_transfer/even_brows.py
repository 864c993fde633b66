"""Brows move as bands: what their tracked points do is evened out along them.

A tracker's points of one brow part by more than a brow bends: its middle goes up by itself. Carried to another brow, that lies elsewhere
between those points, it becomes a hook.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.smoothstep import smoothstep
from engine.perception.face.head_pose import canonical_face

BROW_HEIGHTS = (-0.15, -0.25)
"""Heights between which a face becomes brows and forehead (`canonical_face`)."""
SPREAD_EYE_DISTANCES = (0.2, 0.05)
"""Eye distances along brows and across them over which motion is evened out, as a Gaussian: a brow is 0.6 long."""


def brow_share() -> NDArray[np.float64]:
    """(478,) how far each vertex belongs to brows and forehead."""
    return smoothstep(canonical_face()[:, 1], *BROW_HEIGHTS)


@cache
def even_brows() -> NDArray[np.float64]:
    """(478, 478) evens out what brows and forehead do; products with (478, ...)."""
    face = canonical_face()[:, :2].astype(float)
    share = brow_share()
    apart = ((face[:, None] - face) / SPREAD_EYE_DISTANCES) ** 2
    near = np.exp(-0.5 * apart.sum(axis=2)) * share
    near /= np.maximum(near.sum(axis=1, keepdims=True), 1e-12)
    return np.asarray(share[:, None] * near + np.diag(1 - share))
