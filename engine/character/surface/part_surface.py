"""A part of the person as a surface: the template's part, warped to the outline in the picture.

The paper's section 4.1: boundary matching, warp in mean value coordinates, holes filled (4.1.2), depth of the outline from
the template's depth (equation 2), and depth inside from the warped normals (equations 3 and 4). The same for the back
(4.1.3), whose outline is the front's.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from engine.character.fit.template_maps import SideMaps
from engine.geometry.boundary_matching import match_boundaries
from engine.geometry.deformation.mean_value_coordinates import mean_value_warp
from engine.geometry.normal_integration import integrate_normals
from engine.imaging.filling.grid_diffusion import diffuse
from engine.imaging.filling.harmonic_fill import HarmonicFill, harmonic_fill
from engine.imaging.filling.nearest import nearest_in
from engine.imaging.masks.mask_pieces import outline

OUTLINE_DEPTH_SMOOTHING_PIXELS = 10.0
"""Pixels along the outline over which its depth is smoothed: the template's own outline jumps where limbs overlap."""
NORMAL_SMOOTHING_PIXELS = 1.5
"""Pixels over which warped normals are smoothed."""
CLOTH_NORMAL_SMOOTHING_PIXELS = 6.0
"""Pixels over which warped normals are smoothed where clothes are: they hide what the body has beneath."""
SKIN_WEIGHT_ROUNDS, CLOTH_WEIGHT_ROUNDS = 6, 220
"""Rounds in which skinning weights spread, on skin and then on clothes: over 2 and 12 pixels."""
LOOKUP_DILATION_PIXELS = 2
"""Pixels around those that are looked up within which others are filled, too: the face moves them a little."""
MAX_EXTRA_DEPTH_SHARE = 0.15
"""By how much of the template's own depth a part may reach beyond it: limbs that point at the viewer have normals that say
little, and their depth would run away."""


@dataclass(frozen=True)
class Surface:
    """One side of a part, (H, W) maps: `depth` is z of picture space, NaN outside the part; skinning `weights`
    (H, W, J)."""

    depth: NDArray[np.float32]
    weights: NDArray[np.float32]


@dataclass(frozen=True)
class Warp:
    """The paper's f, from a part in the picture to the template's.

    border : (m, 2) of the part.
    partners : (m, 2) of the border on the template's outline.
    places : (H, W, 2) where each pixel goes.
    wanted : (H, W) the pixels that are looked up.
    """

    border: NDArray[np.float64]
    partners: NDArray[np.float64]
    places: NDArray[np.float32]
    wanted: NDArray[np.bool_]


def warp_part(mask: NDArray[np.bool_], template: NDArray[np.bool_]) -> Warp:
    """The warp of a part that covers `mask` (H, W), one connected piece, to the template's part `template` (H, W):
    equations 6 to 11. Front and back share it, because they share their outlines."""
    border, reference = outline(mask), outline(template)
    partners = reference[match_boundaries(border, reference)]
    ys, xs = np.nonzero(mask)
    places = np.full((*mask.shape, 2), -1, np.float32)
    places[ys, xs] = mean_value_warp(np.stack([xs, ys], 1), border, partners)
    looked_up = np.zeros(mask.shape, np.uint8)
    x, y = np.clip(np.rint(places[ys, xs]), 0, [mask.shape[1] - 1, mask.shape[0] - 1]).astype(int).T
    looked_up[y, x] = 1
    wanted = cv2.dilate(looked_up, np.ones((3, 3), np.uint8), iterations=LOOKUP_DILATION_PIXELS) > 0
    return Warp(border, partners, places, wanted)


@dataclass(frozen=True)
class Filled:
    """Maps of one side of the template without holes (4.1.2): `nearest`, rows and columns of the known pixel that is nearest
    to each, and `holes`, which fills smoothly what is looked up."""

    nearest: tuple[NDArray[np.intp], NDArray[np.intp]]
    holes: HarmonicFill


def filled(warp: Warp, template: SideMaps) -> Filled:
    """Where a part ends at a cut one sees into it: that side's surface is not known there."""
    known = template.mask & (template.normals[..., 2] > 0)
    return Filled(nearest_in(known), harmonic_fill(known, warp.wanted))


def part_surface(
    mask: NDArray[np.bool_],
    warp: Warp,
    template: SideMaps,
    weights: NDArray[np.float32],
    bare: NDArray[np.bool_] | None = None,
) -> Surface:
    """Rebuild one side of a part that covers `mask` (H, W).

    `template`: the part of the template, seen from that side; `weights` (H, W, J) its skinning weights there. `bare` (J,):
    the joints of head, hands and feet; what the others move wears clothes. None: nothing does.
    """
    whole = filled(warp, template)
    carried = _look_up(weights, warp, whole)
    looked = _look_up(template.normals, warp, whole)
    looked /= np.maximum(np.linalg.norm(looked, axis=-1, keepdims=True), 1e-6)
    looked = np.where(mask[..., None], looked, 0)
    normals = np.asarray(cv2.GaussianBlur(looked, (0, 0), NORMAL_SMOOTHING_PIXELS), np.float32)
    if bare is not None:
        worn = cv2.GaussianBlur(carried[..., ~bare].sum(-1), (0, 0), CLOTH_NORMAL_SMOOTHING_PIXELS)[..., None]
        normals = normals + np.clip(worn, 0, 1) * (_smooth(looked, mask) - normals)
    depth = template.depth[whole.nearest]
    held = np.zeros(mask.shape, np.bool_)
    at, partners = warp.border.astype(int), warp.partners.astype(int)
    held[at[:, 1], at[:, 0]] = True
    known = np.zeros(mask.shape, np.float32)
    along = depth[partners[:, 1], partners[:, 0]]
    known[at[:, 1], at[:, 0]] = gaussian_filter1d(along, OUTLINE_DEPTH_SMOOTHING_PIXELS, mode="wrap")
    found = template.towards * integrate_normals(normals, mask, held, template.towards * known)
    nearest, furthest = float(np.nanmax(template.depth)), float(np.nanmin(template.depth))
    margin = MAX_EXTRA_DEPTH_SHARE * (nearest - furthest)
    found = np.clip(found, furthest - margin, nearest + margin)
    return Surface(found, _spread(carried, mask, bare))


def _spread(
    weights: NDArray[np.float32], mask: NDArray[np.bool_], bare: NDArray[np.bool_] | None
) -> NDArray[np.float32]:
    """Weights (H, W, J) spread within the mask, summing to one: clothes bend more widely than skin (`bare` joints)."""
    inside = weights[mask]
    moving = np.flatnonzero(inside.any(0))
    near = diffuse(inside[:, moving], mask, SKIN_WEIGHT_ROUNDS)
    spread = diffuse(near, mask, CLOTH_WEIGHT_ROUNDS)
    if bare is not None:
        skin = near[:, bare[moving]].sum(1, keepdims=True)
        spread += np.clip(skin, 0, 1) * (near - spread)
    spread /= np.maximum(spread.sum(1, keepdims=True), 1e-6)
    out = np.zeros_like(weights)
    rows, columns = np.nonzero(mask)
    out[rows[:, None], columns[:, None], moving] = spread
    return out


def _smooth(normals: NDArray[np.float32], mask: NDArray[np.bool_]) -> NDArray[np.float32]:
    """Normals smoothed over `CLOTH_NORMAL_SMOOTHING_PIXELS` pixels where they are not near the outline, at which they
    must turn away."""
    wide = np.asarray(cv2.GaussianBlur(normals, (0, 0), CLOTH_NORMAL_SMOOTHING_PIXELS), np.float32)
    narrow = np.asarray(cv2.GaussianBlur(normals, (0, 0), NORMAL_SMOOTHING_PIXELS), np.float32)
    inner = np.asarray(cv2.distanceTransform(mask.astype(np.uint8), cv2.DIST_L2, 5))[..., None]
    return np.asarray(narrow + np.clip(inner / (2 * CLOTH_NORMAL_SMOOTHING_PIXELS), 0, 1) * (wide - narrow), np.float32)


def _look_up(values: NDArray[np.float32], warp: Warp, whole: Filled) -> NDArray[np.float32]:
    """Bilinear values (H, W, C) of the template where each pixel goes, holes filled smoothly."""
    source = whole.holes(values[whole.nearest])
    x, y = np.ascontiguousarray(warp.places[..., 0]), np.ascontiguousarray(warp.places[..., 1])
    pieces = [
        cv2.remap(np.ascontiguousarray(source[..., k : k + 4]), x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        for k in range(0, source.shape[-1], 4)
    ]
    return np.concatenate([piece.reshape(*x.shape, -1) for piece in pieces], -1).astype(np.float32)
