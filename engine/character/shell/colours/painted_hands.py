"""The template's hands in the colours of somebody's skin, where the picture does not show them: with nails, knuckles and creases."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from engine.character.fit.template_fit import load_human
from engine.character.shell.colours.bare_skin import BareHand, hands_of_the_template, metres_past_wrists
from engine.character.shell.colours.texels import texels
from engine.character.shell.template_mesh import template_mesh
from engine.geometry.mesh.surface import vertex_normals
from engine.performances.modelling.hands import painted_hand
from engine.performances.modelling.skin_tone import toned

WRIST_METRES, CUFF_METRES = 0.07, 0.004
"""Metres along the hand over which the arm's colours go over into it, where it is bare and where a sleeve ends."""


def with_painted_hands(
    model: NDArray[np.float32], hands: tuple[BareHand | None, BareHand | None]
) -> NDArray[np.float32]:
    """A texture (S, S, 3) in the template's chart, sRGB levels, whose hands are painted in their tones; those in gloves are as they were."""
    out = model.copy()
    flat = out.reshape(-1, 3)
    for hand, (places, along, colours) in zip(hands, _painted(), strict=True):
        if hand is None:
            continue
        over = CUFF_METRES if hand.cuff > 0 else WRIST_METRES
        share = np.clip((along - hand.cuff) / over, 0, 1)[:, None]
        flat[places] += (share * share * (3 - 2 * share)) * (toned(colours, hand.tone) - flat[places])
    return out


@cache
def _painted() -> tuple[tuple[NDArray[np.intp], NDArray[np.float32], NDArray[np.float32]], ...]:
    """Of each hand which texels (N,) show it, in reading order, how far they are past the wrist (N,), metres, and their colours (N, 3)."""
    mesh, raster = template_mesh(), texels()
    body = load_human().space.mean[mesh.ids].astype(np.float64)
    normals = vertex_normals(body, mesh.triangles)
    found = []
    for bones, past in zip(hands_of_the_template(), metres_past_wrists(), strict=True):
        own = np.asarray((past > 0)[mesh.triangles].any(1) & np.isfinite(past)[mesh.triangles].all(1), np.bool_)
        at = np.flatnonzero((raster.triangle >= 0) & own[raster.triangle])
        corners, shares = mesh.triangles[raster.triangle.ravel()[at]], raster.barycentrics.reshape(-1, 3)[at]
        place, normal = (np.einsum("nk,nkc->nc", shares, each[corners]) for each in (body, normals))
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-9)
        along = np.einsum("nk,nk->n", shares, past[corners])
        found.append((at, along.astype(np.float32), painted_hand(bones, place, normal)))
    return tuple(found)
