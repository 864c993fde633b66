"""The lower lip of an open mouth hangs in a curve, as one does that is held at its corners; the template's own hangs in a V."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from engine.avatar.mouth_chart import mouth_faces
from engine.avatar.registration.template_skin.lip_sides import lip_rims
from engine.avatar.registration.template_skin.skin import Skin
from engine.avatar.registration.template_skin.smooth_field import smooth_field
from engine.body.template import Template

UNITS_OF_HANGING_LIP: Mapping[str, float] = {"jawOpen": 1.0, "mouthClose": -1.0}
"""The units that let the lower lip hang, and that which draws it up again, with what each has of it."""


def hanging_lip(template: Template, skin: Skin) -> NDArray[np.float64]:
    """(S, 3) metres by which the skin of the template has to be moved, beside what its `jawOpen` does, for the lower lip to hang in
    a curve.

    A jaw that turns takes a point of the lip down as much as it takes it back. The template's lip goes back in a curve from the
    middle to the corners, but down in two straight lines. So each place of the rim goes down by the share, from the corners to the
    middle, by which it goes back. The skin of the lip comes along smoothly; the upper lip and what is no lip stay.
    """
    own = template.vertices[skin.vertices].astype(np.float64)
    opened = template.face_units.dense(("jawOpen",))[0, skin.vertices].astype(np.float64)
    _, rim = lip_rims(own, skin.triangles, np.tile(mouth_faces(template), 2))
    across = np.abs(own[rim, 0])
    middle, corner = rim[across.argmin()], rim[across.argmax()]
    share = (opened[rim, 2] - opened[corner, 2]) / (opened[middle, 2] - opened[corner, 2])
    moved = np.zeros_like(own)
    moved[rim, 1] = opened[corner, 1] + share * (opened[middle, 1] - opened[corner, 1]) - opened[rim, 1]
    free = skin.regions["lower_lip"].copy()
    free[rim] = False
    return smooth_field(skin.triangles, free, moved)
