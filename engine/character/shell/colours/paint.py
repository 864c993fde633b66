"""The shell's texture: the picture's own colours where it shows the shell, and what goes on round each part elsewhere."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import cv2
import numpy as np
from numba import prange
from numpy.typing import NDArray

from engine.character.figure.silhouette import Silhouette
from engine.character.parts.label_map import Labels
from engine.character.shell.colours.bare_rows import BareRows, bare_rows, skin_colour
from engine.character.shell.colours.bare_skin import BareSkin, metres_past_wrists
from engine.character.shell.colours.ears import auricles, ear_shade
from engine.character.shell.colours.evidence import witness
from engine.character.shell.colours.head_round import HeadColours, head_round
from engine.character.shell.colours.light_of_the_picture import light_of_the_picture
from engine.character.shell.colours.painted_hands import with_painted_hands
from engine.character.shell.colours.round import BackTexture, coloured_round, with_the_other
from engine.character.shell.colours.shoe_bands import level_round
from engine.character.shell.colours.sole import above_the_sole, sole_shade
from engine.character.shell.colours.texels import SHELL_TEXTURE_SIZE_TEXELS, texels
from engine.character.shell.colours.unrolled import UNROLLED_COLUMNS, unrolled_parts
from engine.character.shell.shell import Shell
from engine.character.shell.template_mesh import template_mesh
from engine.compiled import njit
from engine.imaging.filling.nearest import nearest_in
from engine.imaging.masks.mask_distance import dilate_mask
from engine.render.rasterisation.attributes import interpolate
from engine.render.rasterisation.rasteriser import Raster

FILL_BLEND_TEXELS = 6
"""Texels over which what is shown goes over into what is filled in."""
GUTTER_TEXELS = 16
"""Texels beside the chart that have the colours of the chart."""
MEAN_SAMPLING_STEP = 97
"""One texel of so many is looked at for the mean of all."""
UNKNOWN_ROW_WEIGHT = 0.02
"""How much a part counts, where two meet, whose row has nothing to say."""
OPPOSITE_LIMB = {
    f"{one}_{limb}": f"{two}_{limb}"
    for one, two in (("left", "right"), ("right", "left"))
    for limb in ("arm", "leg", "foot")
}
"""Which limb is the other side's."""
PAINTED_STRIP_ROWS = 256
"""Rows of the texture that are judged at once."""
MIN_PART_SHARE = 0.01
"""Share of a part in what moves a vertex, from which on the part has a say in its colour."""
HEAD_ATTRIBUTE_INDEX, HEAD_COSINES = 4, (0.22, 0.42)
"""Which of a witness's attributes is the share of the head; and the cosines to the viewer at which a head's texels show nothing of the
picture, and it alone."""


def paint_shell(
    rgb: NDArray[np.uint8],
    silhouette: Silhouette,
    labels: Labels,
    shell: Shell,
    back: BackTexture = "see_through",
    hides: NDArray[np.int32] | None = None,
    strange: NDArray[np.bool_] | None = None,
    framed: NDArray[np.float32] | None = None,
    skin: BareSkin | None = None,
) -> NDArray[np.uint8]:
    """The texture (`SHELL_TEXTURE_SIZE_TEXELS`, `SHELL_TEXTURE_SIZE_TEXELS`, 3) of a shell, in the template's own chart.

    Parameters
    ----------
    rgb : (H, W, 3), the picture.
    labels : what each pixel of the grid shows; what hangs over the legs is the trunk's (`Labels.layered`).
    back : what is behind: the front seen through without what only fronts have, all of it, or what the sides of each row say.
    hides : (T, 3), the triangles that are shown and hide others, all of the shell's by default. What else it has is not
        painted.
    strange : (h, w), pixels of the grid that have not the colours of what they are labelled as.
    framed : (V,), from 0 to 1, what of the head ends at hair beside it, and shows the picture at any slant.
    skin : the person's, if any is seen: what is not shown of bare hands and arms has its colours.

    Raises
    ------
    ValueError : of a shell of which triangles have been left out.
    """
    if len(shell.mesh.triangles) != len(template_mesh().triangles):
        raise ValueError("only a whole shell has a chart: what is shown of it is said by `hides`")
    told = witness(rgb, silhouette, labels, shell, hides, strange)
    triangles = shell.mesh.triangles
    of_shown = triangles if hides is None else hides
    parts = [part for part in unrolled_parts() if (part.share[of_shown] > MIN_PART_SHARE).any()]
    evidence = {}
    for part in parts:
        points = interpolate(told.attributes, triangles, part.raster)
        seen = told.of(points)
        evidence[part.name] = seen.colours, seen.source & part.covered, points[..., 3]
    bare = {} if skin is None else _bare_arms(evidence, skin)
    rows, sure = [], []
    head: HeadColours | None = None
    for part in parts:
        own = evidence[part.name]
        if part.name == "head":
            head, known = head_round(*own), np.ones(len(own[0]), np.float32)
            around = head.colours
        elif part.name.endswith("foot"):
            beside = OPPOSITE_LIMB.get(part.name)
            pair = next(((one, evidence[one.name]) for one in parts if one.name == beside), None)
            around, known = level_round(part, own, pair)
        else:
            if (other := OPPOSITE_LIMB.get(part.name)) in evidence:
                own = with_the_other(own, evidence[other])
            ring, leg = part.name in OPPOSITE_LIMB, part.name.endswith("leg")
            around, known = coloured_round(*own, back, part.yoke, ring, leg, bare.get(part.name))
        rows.append(around)
        sure.append(known)
    firsts = np.cumsum([0, *(len(each) for each in rows)])
    places = np.stack([np.stack([part.share, part.along, part.angle], 1) for part in parts], 1)
    raster = texels()
    whole = (SHELL_TEXTURE_SIZE_TEXELS, SHELL_TEXTURE_SIZE_TEXELS)
    shown, painted = np.zeros(whole, np.float32), np.zeros((*whole, 3), np.float32)
    wanted = raster.triangle >= 0
    if hides is not None:
        wanted &= _among(triangles, hides)[raster.triangle]
    used = np.flatnonzero(wanted.any(1))
    for first in range(used[0], used[-1] + 1, PAINTED_STRIP_ROWS):
        strip = slice(first, min(first + PAINTED_STRIP_ROWS, used[-1] + 1))
        part_of_it = Raster(raster.triangle[strip], raster.barycentrics[strip], raster.depth[strip])
        points = interpolate(told.attributes, triangles, part_of_it)
        seen = told.of(points)
        believed = _well_seen(points[..., 3])
        around_it = 0.0 if framed is None else interpolate(framed[:, None], triangles, part_of_it)[..., 0]
        if head is not None:
            which = [part.name for part in parts].index("head")
            at = interpolate(places[:, which].astype(np.float32), triangles, part_of_it)
            believed = believed * _at(head.believed, at[..., 1], at[..., 2])
            around_it = around_it * _at(head.own, at[..., 1], at[..., 2])
        believed = np.maximum(believed, around_it)
        shown[strip] = np.minimum(seen.shown, 1 - points[..., HEAD_ATTRIBUTE_INDEX] * (1 - believed))
        painted[strip] = seen.colours
    soft = _softened(np.where(wanted, shown, 0))
    drawn = np.where(wanted, raster.triangle, -1)
    model = np.zeros_like(painted)
    _filled(model, np.zeros_like(soft), drawn, raster.barycentrics, triangles, places.astype(np.float32),
            np.concatenate(rows), np.concatenate(sure), firsts)  # fmt: skip
    on_template = np.column_stack([ear_shade(), above_the_sole(), auricles()])
    shades = interpolate(on_template, triangles, Raster(drawn, raster.barycentrics, raster.depth))
    if head is not None and head.ears is not None:
        model += shades[..., 2:] * (head.ears.astype(np.float32) - model)
    if skin is not None:
        model = with_painted_hands(model, skin.hands)
    model += light_of_the_picture(painted - model, soft)
    painted = soft[..., None] * painted + (1 - soft[..., None]) * model
    shade = shades[..., 0] * (sole_shade(shades[..., 1]) if shell.shod else 1)
    painted *= np.where(drawn >= 0, soft + (1 - soft) * shade, 1)[..., None]
    out = np.clip(painted + 0.5, 0, 255).astype(np.uint8)
    return _beyond_the_chart(out)


def _bare_arms(
    evidence: Mapping[str, tuple[NDArray[np.float32], NDArray[np.bool_], NDArray[np.floating]]], skin: BareSkin
) -> dict[str, BareRows]:
    """Which rows of unrolled arms, by their names, are bare; both are of one colour. `evidence` is of unrolled parts, as `coloured_round` takes it."""
    found = {}
    for part in unrolled_parts():
        if part.name in evidence and part.name.endswith("arm"):
            own, other = evidence[part.name], evidence.get(OPPOSITE_LIMB[part.name])
            told = own if other is None else with_the_other(own, other)
            past = metres_past_wrists()[("left_arm", "right_arm").index(part.name)]
            wrist = int(part.along[np.nanargmin(np.abs(past))])
            found[part.name] = bare_rows(told[0], told[1], skin.tone, wrist)
    if not found:
        return {}
    colour = skin_colour(np.concatenate([cells for _, cells in found.values()]), skin.tone)
    return {name: BareRows(rows, colour) for name, (rows, _) in found.items()}


def _at(values: NDArray[np.float32], rows: NDArray[np.floating], angles: NDArray[np.floating]) -> NDArray[np.float32]:
    """Values (A, `UNROLLED_COLUMNS`) of an unrolled part at rows and angles (...), radians."""
    columns = ((angles + np.pi) / (2 * np.pi) * UNROLLED_COLUMNS - 0.5).astype(np.float32)
    flat = np.ascontiguousarray(rows, np.float32) - np.float32(0.5)
    return np.asarray(cv2.remap(values, columns, flat, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE), np.float32)


def _among(triangles: NDArray[np.int32], some: NDArray[np.int32]) -> NDArray[np.bool_]:
    """Which of the triangles (T, 3) have all their corners in `some` (S, 3)."""
    there = np.zeros(int(triangles.max()) + 1, np.bool_)
    there[some] = True
    return np.asarray(there[triangles].all(1))


def _well_seen(towards: NDArray[np.floating]) -> NDArray[np.float32]:
    """How far what a head shows is the picture's, by the cosine to the viewer: where few pixels are drawn out over it, it is not."""
    least, all_ = HEAD_COSINES
    return np.asarray(np.clip((towards - least) / (all_ - least), 0, 1), np.float32)


def _softened(shown: NDArray[np.float32]) -> NDArray[np.float32]:
    """How far texels show the picture, (S, S), falling softly to nothing at the border of what is shown."""
    within = cv2.distanceTransform((shown > 0).astype(np.uint8), cv2.DIST_L2, 3)
    return np.asarray(np.minimum(shown, np.clip(within / FILL_BLEND_TEXELS, 0, 1)), np.float32)


@cache
def _gutter() -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]:
    """Rows and columns of the texels beside the chart, and of those on it that are nearest to them."""
    on = texels().triangle >= 0
    y, x = np.nonzero(~on & dilate_mask(on, GUTTER_TEXELS))
    rows, columns = nearest_in(on)
    return y, x, rows[y, x], columns[y, x]


def _beyond_the_chart(texture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The texture with its chart's colours beside it, so that none other is mixed into them when it is seen from far away."""
    on = texels().triangle >= 0
    texture[~on] = texture[on][::MEAN_SAMPLING_STEP].mean(0)
    y, x, rows, columns = _gutter()
    texture[y, x] = texture[rows, columns]
    return texture


@njit(parallel=True, boundscheck=False, error_model="numpy")
def _filled(
    painted: np.ndarray,
    shown: np.ndarray,
    triangle: np.ndarray,
    barycentrics: np.ndarray,
    triangles: np.ndarray,
    places: np.ndarray,
    rows: np.ndarray,
    sure: np.ndarray,
    firsts: np.ndarray,
) -> None:
    """Mix into `painted` (S, S, 3) what the parts' `rows` (R, `UNROLLED_COLUMNS`, 3) say, where it is not `shown` (S, S). `places`
    (V, P, 3): of each vertex on each part its share, row and angle; `sure` (R,); `firsts` (P + 1,): where each part's rows begin."""
    turn = 2 * np.pi
    for y in prange(painted.shape[0]):
        for x in range(painted.shape[1]):
            t, own = triangle[y, x], shown[y, x]
            if t < 0 or own >= 1:
                continue
            a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
            wa, wb, wc = barycentrics[y, x, 0], barycentrics[y, x, 1], barycentrics[y, x, 2]
            total, red, green, blue = np.float32(0), np.float32(0), np.float32(0), np.float32(0)
            for part in range(places.shape[1]):
                share = wa * places[a, part, 0] + wb * places[b, part, 0] + wc * places[c, part, 0]
                if share <= MIN_PART_SHARE:
                    continue
                along = wa * places[a, part, 1] + wb * places[b, part, 1] + wc * places[c, part, 1]
                first = places[a, part, 2]
                second = first + (places[b, part, 2] - first + np.pi) % turn - np.pi
                third = first + (places[c, part, 2] - first + np.pi) % turn - np.pi
                column = ((wa * first + wb * second + wc * third) / turn + 0.5) * UNROLLED_COLUMNS - 0.5
                last = firsts[part + 1] - firsts[part] - 1
                row = min(max(along - 0.5, 0.0), np.float64(last))
                top, left = int(row), int(np.floor(column))
                fv, fu = np.float32(row - top), np.float32(column - left)
                bottom = firsts[part] + min(top + 1, last)
                top += firsts[part]
                right, left = (left + 1) % UNROLLED_COLUMNS, left % UNROLLED_COLUMNS
                share *= np.float32(UNKNOWN_ROW_WEIGHT) + (1 - fv) * sure[top] + fv * sure[bottom]
                upper, lower = share * (1 - fv), share * fv
                total += share
                red += upper * ((1 - fu) * rows[top, left, 0] + fu * rows[top, right, 0])
                red += lower * ((1 - fu) * rows[bottom, left, 0] + fu * rows[bottom, right, 0])
                green += upper * ((1 - fu) * rows[top, left, 1] + fu * rows[top, right, 1])
                green += lower * ((1 - fu) * rows[bottom, left, 1] + fu * rows[bottom, right, 1])
                blue += upper * ((1 - fu) * rows[top, left, 2] + fu * rows[top, right, 2])
                blue += lower * ((1 - fu) * rows[bottom, left, 2] + fu * rows[bottom, right, 2])
            if total > 0:
                painted[y, x, 0] = own * painted[y, x, 0] + (1 - own) * red / total
                painted[y, x, 1] = own * painted[y, x, 1] + (1 - own) * green / total
                painted[y, x, 2] = own * painted[y, x, 2] + (1 - own) * blue / total
