"""Skin of lids that frames do not show, painted like the skin beside: what lies in their folds and tucks while eyes are open."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.avatar.registration.eyes.tucked_lids import SLID_EYE_WIDTHS, TUCKED_EYE_WIDTHS
from engine.avatar.texture.template_surface import TemplateSurface
from engine.avatar.texture.template_texture.lid_skin import LidSkin
from engine.avatar.texture.template_texture.part_texels import PartTexels
from engine.face_animation.smoothstep import smoothstep
from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.render.rasterisation.rasteriser import Raster

LOWER_LID_SKIN_EYE_WIDTHS = 0.4
"""Widths of an eye from the rim of its lower lid within which skin is that lid's."""
LASHES_EYE_WIDTHS = 0.12
"""Widths of an eye from its lids' rims within which nothing is believed to be skin: lashes stand there, and their shade lies there."""
RIM_SHADE_SHARE, RIM_SHADE_WIDTH_METRES = 0.5, 0.001
"""Of the light, what lashes take along the rim of a lower lid, and metres over which that fades."""
LASH_LINE_SHARE, LASH_LINE_LIDS = 0.55, 0.09
"""Of the light, what lashes take along a shut lid's rim, and how much of the way up to its fold that fades over."""
CREASE_SHARE, CREASE_LIDS, CREASE_END_SHARE = 0.28, 0.16, 0.25
"""Of the light, what is lost in a shut lid's crease, how much of the way down from the fold that fades over, and over how much of the way
from the eye's corners it sets in."""
SOCKET_SHADE_SHARE = 0.6
"""Of what a lid's surroundings above its fold are darker than its skin, as brows and the shade of a deep socket are, what the lid is at
its fold."""
FOLD_LIDS = (0.65, 1.0)
"""Of the way up to the fold, between which a lid's colours go over to what frames show above: skin, or a brow, or shade."""
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


def place_lids(
    texture: NDArray[np.uint8], surface: TemplateSurface, vertices: NDArray[np.floating], raster: Raster
) -> None:
    """Paint what lies in the lids' folds of the person whose template vertices are (V, 3) into a `texture` (S, S, 3), in place. It is a
    smooth skin from the lower lid's to what is skin above the upper lid's fold. Lashes stand along its rim, and the fold is a crease."""
    places = np.asarray(vertices, np.float64)
    flat = texture.reshape(-1, 3)
    folds = surface.lid_folds(places)
    skin = surface.of("body") & ~surface.sockets & ~surface.mouth & ~np.any(list(folds.values()), axis=0)
    for part, folded in folds.items():
        eye = _Eye(places[surface.lid_rims[part]])
        texels = PartTexels.of(raster, folded | surface.tucked(part, places)[1])
        lid_skin = surface.lid_skin(part, places)
        middles = places[surface.triangles].mean(1)
        near = skin & (eye.away(middles, SLID_EYE_WIDTHS) < SLID_EYE_WIDTHS)
        above = near & (lid_skin[surface.triangles, 0] > SEEN_ABOVE_EYE_WIDTHS).all(1)
        below = skin & (eye.away(middles, LOWER_LID_SKIN_EYE_WIDTHS) < LOWER_LID_SKIN_EYE_WIDTHS)
        below &= middles[:, 1] < eye.rim[:, 1].mean()
        shown = {
            name: PartTexels.of(raster, which) for name, which in (("near", near), ("above", above), ("below", below))
        }
        at = {name: some.blend(places, surface.triangles) for name, some in shown.items()}
        bare = eye.away(at["below"]) > LASHES_EYE_WIDTHS
        if not len(texels.texels) or not bare.any() or not len(at["above"]):
            continue
        colours = {name: flat[some.texels] for name, some in shown.items()}
        lids = LidSkin.between(
            colours["below"][bare], eye.across(at["below"][bare]), colours["above"], eye.across(at["above"])
        )
        here = texels.blend(places, surface.triangles)
        length, up = texels.blend(lid_skin, surface.triangles).T
        upper = np.isin(surface.triangles[texels.triangles], surface.lid_columns[part]).all(axis=1)
        across = eye.across(here)
        painted = lids.at(across, np.where(upper, up, 0))
        seen, over = np.empty_like(painted), smoothstep(up, *FOLD_LIDS)
        _, seen[upper] = _mean_near(colours["above"], at["above"], here[upper], SEEN_ABOVE_TEXELS)
        distance, seen[~upper] = _mean_near(colours["near"], at["near"], here[~upper], LID_BORDER_TEXELS)
        over[~upper] = np.exp(-distance / LID_BORDER_METRES)
        darker = np.clip(1 - (seen @ LUMINANCE_WEIGHTS) / np.maximum(painted @ LUMINANCE_WEIGHTS, 1), 0, 1)
        shut = _shut_light(across, np.minimum(up, 1), darker)
        open_rim = 1 - RIM_SHADE_SHARE * np.exp(-eye.away(here) * eye.width / RIM_SHADE_WIDTH_METRES)
        painted *= np.where(upper, shut, open_rim)[:, None]
        painted += over[:, None] * (seen - painted)
        out = smoothstep(length, *OUT_OF_TUCK_EYE_WIDTHS)[:, None]
        texels.put(texture, painted + out * (flat[texels.texels] - painted))


class _Eye:
    """An eye about which lids end in a `rim` (R, 3), metres."""

    def __init__(self, rim: NDArray[np.float64]) -> None:
        self.rim, self.width = rim, float(np.ptp(rim, axis=0).max())
        steps = np.arange(LASH_RIM_STEPS) / LASH_RIM_STEPS
        self._loop = cKDTree((rim + steps[:, None, None] * (np.roll(rim, -1, 0) - rim)).reshape(-1, 3))
        self._first, self._last = rim[np.argmin(rim[:, 0])], rim[np.argmax(rim[:, 0])]

    def away(self, places: NDArray[np.float64], within: float = np.inf) -> NDArray[np.float64]:
        """(N,) widths of the eye from `places` (N, 3) to its rim; inf where that is more than `within`."""
        return np.asarray(self._loop.query(places, distance_upper_bound=within * self.width)[0]) / self.width

    def across(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """(N,) how far `places` (N, 3) are from one corner to the other, 0 to 1 between them."""
        way = self._last - self._first
        return np.asarray((places - self._first) @ way / (way @ way))


def _shut_light(
    across: NDArray[np.float64], up: NDArray[np.float64], darker: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(N,) the share of the light on a shut upper lid at places `across` the eye and `up` to its fold, above which it is `darker`."""
    lashes = 1 - LASH_LINE_SHARE * np.exp(-up / LASH_LINE_LIDS)
    ends = smoothstep(np.minimum(across, 1 - across), 0, CREASE_END_SHARE)
    crease = 1 - CREASE_SHARE * ends * np.exp(-(1 - up) / CREASE_LIDS)
    return np.asarray(lashes * crease * (1 - SOCKET_SHADE_SHARE * darker * up))


def _mean_near(
    colours: NDArray[np.uint8], places: NDArray[np.float64], asked: NDArray[np.float64], count: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(N,) how far the nearest of the `places` (M, 3) is from those that are `asked` (N, 3), and (N, 3) the mean of the `colours` (M, 3)
    of the `count` nearest."""
    found = cKDTree(places).query(asked, np.arange(1, min(count, len(places)) + 1))
    distance, which = np.asarray(found[0]), np.asarray(found[1])
    return distance[:, 0], np.asarray(colours[which].mean(1))
