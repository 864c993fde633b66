"""Skin of lids that frames do not show, painted like the skin beside: what lies in their folds and tucks while eyes are open."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.avatar.registration.eyes.tucked_lids import LID_SKIN_EYE_WIDTHS, TUCKED_EYE_WIDTHS
from engine.avatar.texture.template_surface import TemplateSurface
from engine.avatar.texture.template_texture.lit_skin import LitSkin
from engine.avatar.texture.template_texture.part_texels import PartTexels
from engine.face_animation.smoothstep import smoothstep
from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.render.rasterisation.rasteriser import Raster

LOWER_LID_SKIN_EYE_WIDTHS = 0.5
"""Widths of an eye from the rim of its lower lid within which the skin below has the lids' colour, in the median."""
SHUT_LASH_SHADE_SHARE, SHUT_LASH_WIDTH_METRES = 0.5, 0.001
"""Of the light, what lashes take along a shut lid's rim, and metres over which that fades."""
OWN_LID_EYE_WIDTHS, BELOW_BROW_EYE_WIDTHS = (0.06, 0.15), (0.08, LID_SKIN_EYE_WIDTHS)
"""Widths of an eye, along the skin that comes out of an upper lid's tuck, from its rim to where its colour begins to go over to what
frames show above, and to where it is that: where they show skin there, and where they show brow or shade."""
BROW_SHADE_SHARE = 0.12
"""Of the light, what a lid below a brow, or deep in its socket, has less than the skin around."""
LASHES_EYE_WIDTHS = 0.12
"""Widths of an eye from its lids' rims within which nothing is believed to be skin: lashes stand there, and their shade lies there."""
OUT_OF_TUCK_EYE_WIDTHS = (TUCKED_EYE_WIDTHS, 0.07)
"""Widths of an eye from the rim of an upper lid that is tucked between which paint goes over to what frames show."""
SEEN_ABOVE_EYE_WIDTHS, SEEN_ABOVE_TEXELS = 0.06, 100
"""Widths of an eye from the rim of an upper lid that is tucked from which on frames show what is above it, not lashes, and texels there
that are asked for their mean."""
LID_BORDER_METRES, LID_BORDER_TEXELS = 0.002, 12
"""Metres over which other painted skin of lids goes over to what frames show beside it, and texels there that are asked for their
mean."""
LASH_RIM_STEPS = 8
"""Places between two vertices of a rim from which it is measured."""


@dataclass(frozen=True)
class _Lids:
    """The N texels of an eye's lids that are painted.

    texels : which they are.
    places : (N, 3) where, metres.
    tucked : (N,) bool, which are of the upper lid's tuck, or partly.
    short, long : (N,) widths of the eye along the skin up from the upper lid's rim with the lid tucked, and untucked.
    """

    texels: PartTexels
    places: NDArray[np.float64]
    tucked: NDArray[np.bool_]
    short: NDArray[np.float64]
    long: NDArray[np.float64]


def place_lids(
    texture: NDArray[np.uint8], surface: TemplateSurface, vertices: NDArray[np.floating], raster: Raster
) -> None:
    """Paint what lies in the lids' folds of the person whose template vertices are (V, 3) like the lit skin around the eyes, with lashes along
    the rim, into a `texture` (S, S, 3), in place. What comes out of an upper lid's tuck goes over to what frames show above it: early to
    skin, and at its very end to a brow that reaches down there, or to a socket's shade."""
    places = np.asarray(vertices, np.float64)
    flat = texture.reshape(-1, 3)
    folds = surface.lid_folds(places)
    skin = surface.of("body") & ~surface.sockets & ~surface.mouth & ~np.any(list(folds.values()), axis=0)
    middles = places[surface.triangles].mean(1)
    for part, folded in folds.items():
        rim = places[surface.lid_rims[part]]
        steps = np.arange(LASH_RIM_STEPS) / LASH_RIM_STEPS
        loop = cKDTree((rim + steps[:, None, None] * (np.roll(rim, -1, 0) - rim)).reshape(-1, 3))
        width = float(np.ptp(rim, axis=0).max())
        near = skin & np.isfinite(loop.query(middles, distance_upper_bound=LOWER_LID_SKIN_EYE_WIDTHS * width)[0])
        below = PartTexels.of(raster, near & (middles[:, 1] < rim[:, 1].mean()))
        whole, partly = surface.tucked(part, places)
        texels = PartTexels.of(raster, folded | partly)
        if not len(below.texels) or not len(texels.texels):
            continue
        lid_skin = surface.lid_skin(part, places)
        lids = _Lids(
            texels,
            texels.blend(places, surface.triangles),
            (whole | partly)[texels.triangles],
            *texels.blend(lid_skin, surface.triangles).T,
        )
        away = np.where(lids.tucked, lids.long * width, loop.query(lids.places)[0])
        light = (1 - SHUT_LASH_SHADE_SHARE * np.exp(-away / SHUT_LASH_WIDTH_METRES))[:, None]
        skin_light = float(np.median(flat[below.texels] @ LUMINANCE_WEIGHTS))
        around = PartTexels.of(raster, near)
        at = around.blend(places, surface.triangles)
        bare = np.asarray(loop.query(at)[0]) > LASHES_EYE_WIDTHS * width
        if not bare.any():
            continue
        middle = rim.mean(0)
        lit = LitSkin.around(flat[around.texels[bare]], (at[bare] - middle) / width, skin_light)
        skin_colours = lit.at((lids.places - middle) / width)
        painted = light * skin_colours
        above = near & (lid_skin[surface.triangles, 0] > SEEN_ABOVE_EYE_WIDTHS).all(1)
        distance, seen = np.empty(len(away)), np.empty_like(painted)
        for some, shown, count in ((~lids.tucked, near, LID_BORDER_TEXELS), (lids.tucked, above, SEEN_ABOVE_TEXELS)):
            beside = PartTexels.of(raster, shown)
            on_skin = beside.blend(places, surface.triangles)
            distance[some], seen[some] = _mean_near(flat[beside.texels], on_skin, lids.places[some], count)
        early, late = (smoothstep(lids.long, *bounds) for bounds in (OWN_LID_EYE_WIDTHS, BELOW_BROW_EYE_WIDTHS))
        over = np.where(lids.tucked, late + lit.trust(seen) * (early - late), np.exp(-distance / LID_BORDER_METRES))
        painted *= 1 - np.where(lids.tucked, BROW_SHADE_SHARE * (1 - lit.trust(seen)), 0)[:, None]
        painted += over[:, None] * (seen - painted)
        out = smoothstep(lids.short, *OUT_OF_TUCK_EYE_WIDTHS)[:, None]
        texels.put(texture, painted + out * (flat[texels.texels] - painted))


def _mean_near(
    colours: NDArray[np.uint8], places: NDArray[np.float64], asked: NDArray[np.float64], count: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(N,) how far the nearest of the `places` (M, 3) is from those that are `asked` (N, 3), and (N, 3) the mean of the `colours` (M, 3)
    of the `count` nearest."""
    found = cKDTree(places).query(asked, np.arange(1, min(count, len(places)) + 1))
    distance, which = np.asarray(found[0]), np.asarray(found[1])
    return distance[:, 0], np.asarray(colours[which].mean(1))
