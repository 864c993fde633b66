"""Lips of an open mouth, as thick as the driver's are beside theirs at rest.

What a wide open mouth does to lips is carried over as a way: thin lips then lose as many pixels as thick ones, and what
corrects points or keeps them inside the contour takes more. A painted mouth became a hole in the skin. So after all else each lip
has at least the share of its thickness that the driver's keeps.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.closing import lip_influence, thickness_influence
from engine.face_animation.mouth.lips_and_skin import LIP_COLUMNS

MIDDLE_COLUMNS = slice(2, 7)
"""Of a lip's nine columns, those by which its thickness is told: beside the corners it is too thin to be measured."""
THICKNESS_SHARES = (0.4, 1.0)
"""Of their thickness at rest, between which an open mouth's lips are to have: no lip is thinner than the first, however it is stretched."""
BORDER_SHARE = 0.5
"""Of what a lip lacks, that its border goes out; its inner edge goes into the opening by the rest."""
MAX_OPENING_SHARE = 0.25
"""Of the opening, that each inner edge goes into it, at most."""


def thickness_shares(faces: NDArray[np.floating], neutral: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N, 2) what share of its thickness on a `neutral` face (478, 2 or 3) the upper and the lower lip have on others (N, 478, 2
    or 3) of the same scale, within `THICKNESS_SHARES`."""
    now, rest = _thickness(faces), _thickness(neutral[None])
    share = now[..., MIDDLE_COLUMNS].mean(axis=-1) / np.maximum(rest[..., MIDDLE_COLUMNS].mean(axis=-1), 1e-6)
    return np.asarray(np.clip(share, *THICKNESS_SHARES))


def keep_thickness(placed: NDArray[np.floating], rigid: NDArray[np.floating], shares: NDArray[np.floating]) -> None:
    """Make lips at least as thick as a share of what they are at rest, in place.

    Parameters
    ----------
    placed : (N, 478, 2) the face, pixels. rigid : (N, 478, 2) where the head alone carries its rest. shares : (N, 2) of the upper and the lower
        lip, from `thickness_shares`.
    """
    columns = np.array(LIP_COLUMNS)
    inner, border = columns[..., -2], columns[..., -1]
    gap = np.linalg.norm(placed[:, inner[1]] - placed[:, inner[0]], axis=-1)
    usual = _thickness(rigid)
    for lip, (whole, outer) in enumerate(zip(lip_influence(), thickness_influence(), strict=True)):
        out = placed[:, border[lip]] - placed[:, inner[lip]]
        thick = np.linalg.norm(out, axis=-1)
        way = rigid[:, border[lip]] - rigid[:, inner[lip]]
        way = way / np.maximum(np.linalg.norm(way, axis=-1, keepdims=True), 1e-6)
        lack = np.maximum(shares[:, lip, None] * usual[:, lip] - np.copysign(thick, (out * way).sum(axis=-1)), 0)
        inwards = np.minimum((1 - BORDER_SHARE) * lack, MAX_OPENING_SHARE * gap)
        placed += np.einsum("vk,nkd->nvd", outer, (lack - inwards)[..., None] * way)
        placed -= np.einsum("vk,nkd->nvd", whole - outer, inwards[..., None] * way)


def _thickness(faces: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N, 2, 9) of the columns of both lips of faces (N, 478, 2 or 3), the upper one first."""
    columns = np.array(LIP_COLUMNS)
    return np.asarray(np.linalg.norm(faces[:, columns[..., -1], :2] - faces[:, columns[..., -2], :2], axis=-1), float)
