"""The head's back: what surrounds the face, hair, a hat or skin, goes round as it does on other parts; the face does not.

Where a head has a face is the same on all templates, so nothing has to be found but what is skin and what is not. What is
not goes round at its own height, a hat above as a hat, hair below as hair; from the ears down, where the outline shows skin, what is
above goes on to the nape.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.fit.template_fit import load_human
from engine.character.shell.colours.round import (
    COLUMN_SINES,
    continued_rows,
    joined,
    row_middles,
    row_model,
    turned_rows,
)
from engine.character.shell.colours.unrolled import COLUMNS, ROW_METRES, unrolled_parts
from engine.character.shell.template_mesh import template_mesh

BROW_LANDMARKS, EYE_LANDMARKS, NOSE_TIP_LANDMARK, CHIN_LANDMARK = slice(17, 27), slice(36, 48), 30, 8
"""Of the 68 points of a face."""
FACE_EDGE_RADIANS, CHEEK_EDGE_RADIANS = 1.0, 0.65
"""Radians from its middle to where a face ends and temples and ears begin; and up to where there is surely no hair beside it."""
BARE_SKIN_RADIANS = 0.35
"""Radians from its middle up to which a face is bare between eyes and nose, above all beards and below spectacles."""
MIN_HALF_FACE_SHARE = 0.5
"""Share of one half of a face, below which so little of it is seen that the other half says what it is."""
MIN_HAIRLINE_SHARE = 0.25
"""How far above the brows hair begins at the earliest, as a share of the way to the crown."""
HAIR_EDGE_RADIANS = {"nape": 2.5, "nose": 2.0, "eyes": 1.8, "brow": 1.4, "forehead": 1.0, "crown": 0.0}
"""Radians from the face's middle beyond which hair is, by the height: in front of the nape is the neck, before it the ear."""
MIN_HAIR_COLOUR_DISTANCE = 14.0
"""CIE Lab distance, lightness counting 0.7 and hues 1.5, from which hair can be told from skin."""
MIN_NOT_SKIN_COLOUR_DISTANCE = 25.0
"""The same, from which a colour is no skin of this face ..."""
MAX_LIGHTER_DISTANCE = 5.0
"""... where no colour is lighter than its skin by more than this: light may fall on it."""
MIN_COLOUR_CELLS = 40
"""Cells from which a colour is known."""
LONG_HAIR_SHARE = 0.5
"""Share of what is beside the cheeks that is hair, if hair is long, and goes down to the neck."""
HAIR_EDGE_METRES = 0.008
"""Metres over which hair ends."""
EAR_EDGE_METRES = 0.008
"""The same of ears."""
EAR_LIGHT_RADIANS = 0.7
"""Radians from the face's middle beyond which skin has the light of the ears."""
NAPE_HEIGHT_SHARE = 0.35
"""How far above the chin hair ends behind, as a share of the way to the nose."""
NECK_EDGE_RADIANS = 1.5
"""Radians from the face's middle beyond which the neck goes round."""
STRAND_BAND_SHARE = 0.6
"""Share of the way from the hairline to the crown in which strands are looked at."""
STRAND_SCALE_METRES, MAX_STRAND_CONTRAST_LEVELS = 0.01, 25.0
"""Metres over which what is fine about hair averages out; and sRGB levels beyond which it is no strand, but a badge or a comb."""
CENTRE_WEIGHT = 0.05
"""How much the middle counts beside the sides: a crown is seen from before."""
LAB_WEIGHTS = np.array([0.7, 1.5, 1.5], np.float32)


@dataclass(frozen=True)
class HeadMap:
    """Where on the unrolled head things are. `height` (A, 1): metres up on the mean body of each row; `angle` (1,
    `COLUMNS`): radians from the face's middle; `ears` (A, `COLUMNS`); `levels`: heights by name."""

    height: NDArray[np.float32]
    angle: NDArray[np.float32]
    ears: NDArray[np.bool_]
    levels: dict[str, float]


@cache
def head_map() -> HeadMap:
    """The head's, once for the process."""
    mesh, human = template_mesh(), load_human()
    part = unrolled_parts()[0]
    face = mesh.renamed(human.face)
    row = part.along
    levels = {
        name: float(row[face[which]].mean()) for name, which in (("brow", BROW_LANDMARKS), ("eyes", EYE_LANDMARKS))
    }
    levels |= {name: float(row[face[which]]) for name, which in (("nose", NOSE_TIP_LANDMARK), ("chin", CHIN_LANDMARK))}
    rows = len(part.raster.triangle)
    levels |= {"crown": float(rows), "forehead": (levels["brow"] + rows) / 2}
    levels["nape"] = levels["chin"] + NAPE_HEIGHT_SHARE * (levels["nose"] - levels["chin"])
    angle = (np.arange(COLUMNS) + 0.5) / COLUMNS * 2 * np.pi - np.pi
    around = np.asarray(mesh.ear[mesh.triangles[part.raster.triangle]].all(-1), np.uint8)
    ears = np.asarray(cv2.erode(around, np.ones((7, 7), np.uint8)) > 0)
    return HeadMap(
        (np.arange(rows, dtype=np.float32) + 0.5)[:, None], np.abs(angle).astype(np.float32)[None], ears, levels
    )


def head_round(
    colours: NDArray[np.float32], source: NDArray[np.bool_], facing: NDArray[np.float32]
) -> NDArray[np.float32]:
    """The colours (A, `COLUMNS`, 3) of the unrolled head, as `round.coloured_round` has those of other parts."""
    if not source.any():
        return colours
    head = head_map()
    level = head.levels
    hairline = level["brow"] + MIN_HAIRLINE_SHARE * (level["crown"] - level["brow"])
    at_face = (head.height < hairline) & (head.height > level["chin"])
    colours, known = _both_cheeks(
        colours, source, at_face & (head.angle < FACE_EDGE_RADIANS), at_face & (head.angle < CHEEK_EDGE_RADIANS)
    )
    lab = cv2.cvtColor(np.clip(colours, 0, 255) / np.float32(255), cv2.COLOR_RGB2LAB)
    above, beside = head.height > level["nape"], ~(at_face & (head.angle < CHEEK_EDGE_RADIANS)) & ~head.ears
    cheeks = known & (head.angle < BARE_SKIN_RADIANS) & (head.height < level["eyes"]) & (head.height > level["nose"])
    top = source & beside & (head.height > hairline)
    own = source & beside
    ears = None
    long = False
    if cheeks.sum() > MIN_COLOUR_CELLS and top.sum() > MIN_COLOUR_CELLS:
        skin, hair = np.median(lab[cheeks], 0), np.median(lab[top], 0)
        from_skin, from_hair = (np.linalg.norm((lab - one) * LAB_WEIGHTS, axis=-1) for one in (skin, hair))
        if np.linalg.norm((skin - hair) * LAB_WEIGHTS) > MIN_HAIR_COLOUR_DISTANCE:
            darker = np.minimum(lab - skin, [MAX_LIGHTER_DISTANCE, np.inf, np.inf])
            bare = (from_skin < from_hair) & (
                np.linalg.norm(darker * LAB_WEIGHTS, axis=-1) < MIN_NOT_SKIN_COLOUR_DISTANCE
            )
            sides = source & (head.angle > 0.9) & (head.height < level["nose"]) & (head.height > level["chin"])
            long = bool(sides.sum() > MIN_COLOUR_CELLS and (~bare)[sides].mean() > LONG_HAIR_SHARE)
            own &= ~(bare & (above | long))
            flanks = source & bare & above & (head.angle > EAR_LIGHT_RADIANS) & (head.height < level["brow"])
            ears = np.median(colours[flanks if flanks.sum() > MIN_COLOUR_CELLS else cheeks], 0)
    if long:
        above = np.ones_like(above)
    begins = np.interp(head.height, *_limits(level, long)).astype(np.float32)
    behind = _soft(
        np.where(above, (head.angle > begins) | (head.height > hairline), head.angle > NECK_EDGE_RADIANS),
        HAIR_EDGE_METRES,
    )[..., None]
    middles = row_middles(facing)
    seen, near, high = (turned_rows(each, -middles) for each in (colours, np.maximum(facing, 0), own & above))
    model = np.zeros_like(seen)
    for rows, weight in (
        (above[:, 0], high * near * (CENTRE_WEIGHT + COLUMN_SINES**2)),
        (~above[:, 0], turned_rows(known & ~above, -middles) * near * COLUMN_SINES**2),
    ):
        if rows.any() and weight.any():
            model[rows] = row_model(seen, weight).colours[rows]
    model += (
        _strands(seen - model, high, int(hairline))
        * turned_rows(np.broadcast_to(above, known.shape), -middles)[..., None]
    )
    surrounds = np.where(above, own, known)
    model = joined(turned_rows(model, middles), colours, surrounds, surrounds.astype(np.float32))
    filled = behind * model + (1 - behind) * continued_rows(colours, known.astype(np.float32))
    if ears is not None and not long:
        ear = _soft(head.ears, EAR_EDGE_METRES)[..., None]
        filled = ear * ears + (1 - ear) * filled
    return np.asarray(np.where(known[..., None], colours, filled), np.float32)


def _strands(detail: NDArray[np.float32], hair: NDArray[np.bool_], hairline: int) -> NDArray[np.float32]:
    """What is fine about the `hair` (A, `COLUMNS`), `detail` (A, `COLUMNS`, 3), laid behind: seen through, and below
    the hairline mirrored there and back."""
    whole = cv2.erode(hair.astype(np.uint8), np.ones((5, 5), np.uint8)).astype(np.float32)
    share = np.maximum(cv2.GaussianBlur(whole, (0, 0), STRAND_SCALE_METRES / ROW_METRES), 1e-3)[..., None]
    fine = detail - cv2.GaussianBlur(detail * whole[..., None], (0, 0), STRAND_SCALE_METRES / ROW_METRES) / share
    fine = (
        fine
        * (cv2.blur(whole, (5, 5)) / (1 + (np.linalg.norm(fine, axis=-1) / MAX_STRAND_CONTRAST_LEVELS) ** 4))[..., None]
    )
    rows = np.arange(len(detail))
    span = max(int(STRAND_BAND_SHARE * (len(detail) - hairline)), 1)
    away = np.abs(rows - hairline) % (2 * span)
    mirrored = np.where(rows < hairline, hairline + np.minimum(away, 2 * span - away), rows)
    partner = (COLUMNS // 2 - 1 - np.arange(COLUMNS)) % COLUMNS
    return fine[np.minimum(mirrored, len(detail) - 1)[:, None], partner]


def _both_cheeks(
    colours: NDArray[np.float32], known: NDArray[np.bool_], on_face: NDArray[np.bool_], middle: NDArray[np.bool_]
) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
    """A face that is seen from its side has on the other what it has on this one, in its own light: where it is `on_face`
    (A, `COLUMNS`), if of its `middle` (A, `COLUMNS`) one half is hardly seen."""
    mirrored, there = colours[:, ::-1], known[:, ::-1]
    lacks = there & ~known & on_face
    both = there & known & on_face
    half = np.arange(COLUMNS) < COLUMNS // 2
    lacking = half if (lacks & half).sum() > (lacks & ~half).sum() else ~half
    if not lacks.any() or known[middle & lacking].mean() > MIN_HALF_FACE_SHARE:
        return colours, known
    near = both & lacking
    gain = np.ones(3, np.float32)
    if near.sum() > MIN_COLOUR_CELLS:
        gain = np.clip(np.median(colours[near], 0) / np.maximum(np.median(mirrored[near], 0), 4), 0.4, 2.5)
    return np.where(lacks[..., None], mirrored * gain, colours).astype(np.float32), known | lacks


def _limits(level: dict[str, float], long: bool) -> tuple[list[float], list[float]]:
    names = sorted(HAIR_EDGE_RADIANS, key=lambda name: level[name])
    return [level[name] for name in names], [
        min(HAIR_EDGE_RADIANS[name], 1.3) if long else HAIR_EDGE_RADIANS[name] for name in names
    ]


def _soft(mask: NDArray[np.bool_], metres: float) -> NDArray[np.float32]:
    return np.asarray(cv2.GaussianBlur(mask.astype(np.float32), (0, 0), metres / ROW_METRES), np.float32)
