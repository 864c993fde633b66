"""The light that reaches what is in a mouth: through the slot between the lips, and by way of the flesh around it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.face_animation.mouth.lip_contours import LOWER_INNER_LIP, UPPER_INNER_LIP

BEHIND_SLOT_MOUTH_WIDTHS, BEHIND_CORNERS_MOUTH_WIDTHS = 0.03, 0.14
"""Widths of the mouth by which what is lit lies behind the lips, and behind the corners, from which rows of teeth go back."""
FULL_LIGHT_VISIBILITY = 0.8
"""Of what is before the face, that is seen from where all of the light falls: the middle of a mouth that smiles."""


def mouth_light(
    face: NDArray[np.floating], corner: NDArray[np.floating], shape: tuple[int, int], albedo: NDArray[np.floating]
) -> NDArray[np.float32]:
    """(h, w, 3) of the light in the mouth of a `face` (478, 2), for the pixels of a part of `shape` (h, w) whose first is at `corner` (2,) of the
    picture. `albedo` (3,) in [0, 1], of what throws light back in there: shadows have its hue.

    A place behind the lips sees the cosine-weighted share of what is before the face that two edges leave it. What
    they take comes by way of flesh in part.

    Source: J. Jimenez, X. Wu, A. Pesce, A. Jarabo, Practical real-time strategies for accurate indirect occlusion, 2016,
    eq. 10.
    """
    upper, lower = (face[list(lip), :2].astype(np.float32) for lip in (UPPER_INNER_LIP, LOWER_INNER_LIP))
    across = upper[-1] - upper[0]
    width = max(float(np.linalg.norm(across)), 1.0)
    axis = across / width
    turn = np.array([axis, (-axis[1], axis[0])]).T / width
    edges = np.stack([(lip - upper[0]) @ turn for lip in (upper, lower)]).astype(np.float32)
    start = (np.asarray(corner, np.float32) - upper[0]) / width
    known = np.asarray(albedo, np.float32)
    fit = np.array([2.0404 * known - 0.3324, 0.6417 - 4.7951 * known, 2.7552 * known + 0.6903], np.float32)
    return np.asarray(_light(*shape, start, np.float32(1 / width), axis, edges, fit), np.float32)


@njit(fastmath=True, nogil=True)
def _light(height, width, start, step, axis, edges, fit):  # type: ignore[no-untyped-def]
    """From `start` (2,) on, a pixel is a `step`, in widths of the mouth. `edges` (2, 11, 2) are the lips along and
    across the mouth, the upper one first. `fit` (3, 3) has for each channel the coefficients of the light by way of
    flesh, the cubic one first."""
    out = np.empty((height, width, 3), np.float32)
    slot, side = np.float32(BEHIND_SLOT_MOUTH_WIDTHS), np.float32(BEHIND_CORNERS_MOUTH_WIDTHS)
    half, one, none = np.float32(0.5), np.float32(1), np.float32(0)
    for y in range(height):
        for x in range(width):
            right = start[0] + x * step
            down = start[1] + y * step
            along = right * axis[0] + down * axis[1]
            across = down * axis[0] - right * axis[1]
            under = max(across - _edge_at(edges[0], along), none)
            above = max(_edge_at(edges[1], along) - across, none)
            seen = half * (under / np.sqrt(under * under + slot * slot) + above / np.sqrt(above * above + slot * slot))
            aside = max(min(along, one - along), none)
            seen *= half * (one + aside / np.sqrt(aside * aside + side * side))
            seen = min(seen / np.float32(FULL_LIGHT_VISIBILITY), one)
            for k in range(3):
                out[y, x, k] = min(max(((fit[0, k] * seen + fit[1, k]) * seen + fit[2, k]) * seen, seen), one)
    return out


@njit(fastmath=True, nogil=True)
def _edge_at(lip, along):  # type: ignore[no-untyped-def]
    """Where a `lip` (11, 2) is across the mouth, `along` it."""
    k = 0
    while k < len(lip) - 2 and along > lip[k + 1, 0]:
        k += 1
    run = max(lip[k + 1, 0] - lip[k, 0], np.float32(1e-6))
    t = min(max((along - lip[k, 0]) / run, np.float32(0)), np.float32(1))
    return lip[k, 1] + t * (lip[k + 1, 1] - lip[k, 1])
