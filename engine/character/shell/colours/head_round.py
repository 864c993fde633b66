"""The head's colours all round: skin and hair each go on as what they are, and which of them a place shows is known of heads.

Beyond the paper, whose back is the front mirrored. A head's side is seen in a strip of few pixels, and its back not at all: colours that
go round in their rows lay a face's edge, an ear and a collar behind. So a place is told to be skin or hair first: by the picture where it
is well seen, and elsewhere by where hair begins on heads. A hat is hair of another colour: it goes round at its own height.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.shell.colours.both_halves import both_halves
from engine.character.shell.colours.hair import (
    HeadSeen,
    hair_share,
    hairline,
    smoothed_rows,
    strand_levels,
    strand_noise,
)
from engine.character.shell.colours.head_map import HeadMap, head_map
from engine.character.shell.colours.round import COLUMN_SINES, joined, row_middles, row_model, turned_rows
from engine.character.shell.colours.unrolled import ROW_METRES, UNROLLED_COLUMNS

MIN_WELL_SEEN_COSINE = 0.35
"""Cosine to the viewer from which on a head's colours are told by the picture: beyond, few pixels are drawn out over its side."""
CHEEK_EDGE_RADIANS = 0.65
"""Radians from its middle up to where there is surely no hair beside a face."""
BARE_SKIN_RADIANS = 0.35
"""Radians from its middle up to which a face is bare between eyes and nose, above all beards and below spectacles."""
MIN_SHOWN_HEAD_COSINE = 0.2
"""Cosine to the viewer from which on anything of the picture may be shown."""
MIN_SIDE_HAIR_RADIANS, HAIRLINE_TOLERANCE_RADIANS = 0.55, 0.03
"""Radians from its middle from which on hair is beside a face, and radians from the hairline in which hair and skin are mixed."""
MIN_HAIR_COLOUR_DISTANCE = 14.0
"""CIE Lab distance, lightness counting 0.7 and hues 1.5, from which hair can be told from skin."""
MIN_NOT_SKIN_COLOUR_DISTANCE = 25.0
"""CIE Lab distance, weighted alike, from which a colour is no skin of this face."""
MAX_LIGHTER_DISTANCE = 5.0
"""By how much a colour counts as lighter than the face's skin there, at most: light may fall on skin."""
MAX_HAIR_COLOUR_DISTANCE = 20.0
"""CIE Lab distance, weighted alike, up to which what is beside the cheeks is of the hair's own colour."""
MIXED_CELLS = 5
"""Cells of a square about what lies on a cheek in which its colours are mixed with skin."""
MIN_COLOUR_CELLS = 40
"""Cells from which a colour is known."""
LONG_HAIR_SHARE = 0.5
"""Share of what is beside the cheeks that is hair, if hair is long, and goes down to the neck."""
SIDE_RADIANS = 0.9
"""Radians from the face's middle beyond which is beside the cheeks."""
HAIR_MARGIN_CELLS = 5
"""Cells of a square that must all be hair where its colour is taken from: at its edge it is mixed with skin."""
HAIR_SMOOTHING_METRES = 0.01
"""Metres along the head over which the hair's colour is averaged."""
CENTRE_WEIGHT = 0.3
"""How much the middle counts beside the sides for the colour of hair."""
TEMPLE_RADIANS = (0.6, 0.78)
"""Radians from its middle from which on a face goes on beside the eyes by itself, and from which on it does so wholly."""
FULLY_SEEN_COSINES = (0.75, 0.88)
"""Cosines to the viewer from which on the side of a turned head is seen more and more, and wholly, as it is."""
EDGE_METRES = 0.004
"""Metres over which hair and ears go over into skin."""
SIDE_SKIN_RADIANS, JAW_RADIANS = 0.7, 1.2
"""Radians from the face's middle between which what is not hair goes on beside the eyes; and up to which a jaw goes on with its beard."""
MIN_CLOTH_SHARE, MIN_CLOTH_CELLS, MIN_CLOTH_ROWS = 0.75, 6, 8
"""Of what is seen of a neck's row the share that is no skin, the cells seen, and the rows of that kind, for a neck to be in cloth."""
HEAD_LAB_WEIGHTS = np.array([0.7, 1.5, 1.5], np.float32)


@dataclass(frozen=True)
class _Kinds:
    """What is well seen of a head, (A, `UNROLLED_COLUMNS`) each but for the last two.

    known : all of it.
    bare : the bare skin.
    hair : hair, or a hat.
    skin_like : what is nearer to the skin's colour than to the hair's.
    skin : (3,) the mean colour of skin, sRGB levels.
    falls : whether hair covers ears and neck.
    """

    known: NDArray[np.bool_]
    bare: NDArray[np.bool_]
    hair: NDArray[np.bool_]
    skin_like: NDArray[np.bool_]
    skin: NDArray[np.floating]
    falls: bool


@dataclass(frozen=True)
class HeadColours:
    """The unrolled head all round.

    colours : (A, `UNROLLED_COLUMNS`, 3) float32, sRGB levels, as `round.coloured_round` has those of other parts; around ears what is
        there without them.
    believed : (A, `UNROLLED_COLUMNS`) float32, from 0 to 1, how far the picture is believed.
    own : (A, `UNROLLED_COLUMNS`) float32, from 0 to 1, how far a place does not have the colours of the other half.
    ears : (3,) of the ears themselves; `None` where hair covers them, or nothing is known.
    """

    colours: NDArray[np.float32]
    believed: NDArray[np.float32]
    own: NDArray[np.float32]
    ears: NDArray[np.floating] | None


def head_round(colours: NDArray[np.float32], source: NDArray[np.bool_], facing: NDArray[np.float32]) -> HeadColours:
    """The head's colours all round, from those (A, `UNROLLED_COLUMNS`, 3) of a picture that shows its `source` (A, `UNROLLED_COLUMNS`) of them, and
    the cosines (A, `UNROLLED_COLUMNS`) to the viewer."""
    everywhere = np.ones(source.shape, np.float32)
    if not source.any():
        return HeadColours(colours, everywhere, everywhere, None)
    head = head_map()
    known = source & (facing > MIN_WELL_SEEN_COSINE)
    first = _kinds(head, colours, known)
    shown = replace(_kinds(head, colours, colours.any(-1) & (facing > MIN_SHOWN_HEAD_COSINE)), falls=first.falls)
    strange = _strange(head, shown, hairline(head, HeadSeen(known, first.hair, facing), falls=first.falls), facing)
    side = head.between("chin", "brow") & (head.angle > TEMPLE_RADIANS[0]) & (facing < FULLY_SEEN_COSINES[0])
    halves = both_halves(head, colours, known & ~strange & ~(side & (not first.falls)), facing)
    believed = _believed(head, halves.facing, falls=first.falls) * halves.own * (1 - _soft(strange)[..., 0])
    colours, known, facing = halves.colours, halves.known, halves.facing
    kinds = replace(_kinds(head, colours, known), falls=first.falls)
    begins = hairline(head, HeadSeen(known, kinds.hair, facing), falls=kinds.falls)
    streaks = strand_noise((len(colours), UNROLLED_COLUMNS))
    skin = _skin(head, colours, kinds)
    ears, shows = (None, known) if kinds.falls else (kinds.skin, known & ~head.around_ears)
    if not kinds.hair.any():
        return HeadColours(np.where(shows[..., None], colours, skin).astype(np.float32), believed, halves.own, ears)
    share = _soft(hair_share(head, begins, HeadSeen(known, kinds.hair, facing), streaks, falls=kinds.falls))
    filled = share * _hair(colours, kinds, facing, streaks) + (1 - share) * skin
    return HeadColours(np.where(shows[..., None], colours, filled).astype(np.float32), believed, halves.own, ears)


def _strange(
    head: HeadMap, kinds: _Kinds, begins: NDArray[np.float32], facing: NDArray[np.float32]
) -> NDArray[np.bool_]:
    """The cells (A, `UNROLLED_COLUMNS`) beside the face, seen at a slant, that are not what is there: hair before where it `begins`, skin behind, and
    what lies on one cheek alone."""
    aslant = (head.angle > MIN_SIDE_HAIR_RADIANS) & (facing < FULLY_SEEN_COSINES[0])
    strange = np.zeros_like(kinds.known)
    if not kinds.falls:
        alone = kinds.known & ~kinds.bare & (kinds.known & kinds.bare)[:, ::-1]
        around = cv2.dilate(alone.astype(np.uint8), np.ones((MIXED_CELLS, MIXED_CELLS), np.uint8)) > 0
        strange |= around & head.between("chin", "brow")
    if kinds.hair.any():
        away = head.angle - begins
        hair, skin = away > -HAIRLINE_TOLERANCE_RADIANS, away < HAIRLINE_TOLERANCE_RADIANS
        strange |= ((kinds.hair & ~hair) | (kinds.bare & ~skin)) & head.between("ears", "forehead")
    return np.asarray(strange & aslant, np.bool_)


def _believed(head: HeadMap, facing: NDArray[np.float32], *, falls: bool) -> NDArray[np.float32]:
    """How far the picture is believed (A, `UNROLLED_COLUMNS`): not between eye and ear, unless hair falls there. A sideburn, an ear, the shadow
    before it and the wall beside are elsewhere on every head, and drawn out over its side; skin goes on by itself."""
    if falls:
        return np.ones(facing.shape, np.float32)
    least, all_ = TEMPLE_RADIANS
    temple = np.clip((head.angle - least) / (all_ - least), 0, 1) * head.between("chin", "brow")
    least, all_ = FULLY_SEEN_COSINES
    temple = temple * (1 - np.clip((facing - least) / (all_ - least), 0, 1))
    return 1 - np.asarray(cv2.GaussianBlur(temple.astype(np.float32), (0, 0), EDGE_METRES / ROW_METRES), np.float32)


def _kinds(head: HeadMap, colours: NDArray[np.float32], known: NDArray[np.bool_]) -> _Kinds:
    lab = cv2.cvtColor(np.clip(colours, 0, 255) / np.float32(255), cv2.COLOR_RGB2LAB)
    beside = ~(head.between("chin", "hairline") & (head.angle < CHEEK_EDGE_RADIANS)) & ~head.ears
    cheeks = known & (head.angle < BARE_SKIN_RADIANS) & head.between("nose", "eyes")
    top = known & beside & head.above("hairline")
    bare, skin_like, falls = np.zeros_like(known), np.zeros_like(known), False
    if cheeks.sum() > MIN_COLOUR_CELLS:
        skin = np.median(lab[cheeks], 0)
        darker = np.minimum(lab - skin, [MAX_LIGHTER_DISTANCE, np.inf, np.inf])
        bare = known & (np.linalg.norm(darker * HEAD_LAB_WEIGHTS, axis=-1) < MIN_NOT_SKIN_COLOUR_DISTANCE)
        skin_like = bare.copy()
        if top.sum() > MIN_COLOUR_CELLS:
            hair = np.median(lab[top], 0)
            from_skin, from_hair = (np.linalg.norm((lab - one) * HEAD_LAB_WEIGHTS, axis=-1) for one in (skin, hair))
            skin_like = known & (from_skin < from_hair)
            bare &= skin_like
            if np.linalg.norm((skin - hair) * HEAD_LAB_WEIGHTS) > MIN_HAIR_COLOUR_DISTANCE:
                sides = known & (head.angle > SIDE_RADIANS) & head.between("chin", "nose")
                of_hair = ~skin_like & (from_hair < MAX_HAIR_COLOUR_DISTANCE)
                falls = bool(sides.sum() > MIN_COLOUR_CELLS and of_hair[sides].mean() > LONG_HAIR_SHARE)
            else:  # as fair as the skin, or none: above the hairline the head is what it is there
                bare &= ~head.above("hairline")
    own = known & ~bare & beside & (falls | head.above("ears"))
    return _Kinds(known, bare, own if top.sum() > MIN_COLOUR_CELLS else np.zeros_like(own), skin_like,
                  _mean_skin(head, colours, known, bare, cheeks), falls)  # fmt: skip


def _mean_skin(
    head: HeadMap,
    colours: NDArray[np.float32],
    known: NDArray[np.bool_],
    bare: NDArray[np.bool_],
    cheeks: NDArray[np.bool_],
) -> NDArray[np.floating]:
    """The colour of the skin beside the face, sRGB levels."""
    for cells in (bare & (head.angle > BARE_SKIN_RADIANS), cheeks, known):
        if cells.sum() > MIN_COLOUR_CELLS:
            return np.asarray(np.median(colours[cells], 0))
    return np.asarray(np.median(colours[known], 0) if known.any() else colours.mean((0, 1)))


def _skin(head: HeadMap, colours: NDArray[np.float32], kinds: _Kinds) -> NDArray[np.float32]:
    """Skin all round (A, `UNROLLED_COLUMNS`, 3), a beard fading out behind it; around the neck what is worn there."""
    skin = np.broadcast_to(kinds.skin, colours.shape).astype(np.float32)
    neck = _neck_cloth(head, colours, kinds)
    if neck is not None:
        skin[: len(neck)] = neck[:, None]
    temples = (
        kinds.skin_like & (head.angle > SIDE_SKIN_RADIANS) & (head.angle < JAW_RADIANS) & head.between("chin", "brow")
    )
    jaw = kinds.known & (head.angle < JAW_RADIANS) & head.between("chin", "ears") & ~kinds.falls
    return joined(skin, colours, kinds.known, (kinds.bare | temples | jaw).astype(np.float32))


def _neck_cloth(head: HeadMap, colours: NDArray[np.float32], kinds: _Kinds) -> NDArray[np.float32] | None:
    """The colours (B, 3) of the neck's rows up to where what is worn around it ends; `None` of a bare neck."""
    low = kinds.known & ~head.above("chin")
    cells, cloth = low.sum(1), low & ~kinds.bare
    share = cv2.blur((cloth.sum(1) / np.maximum(cells, 1)).astype(np.float32)[:, None], (1, 9))[:, 0]
    rows = np.flatnonzero((share > MIN_CLOTH_SHARE) & (cells > MIN_CLOTH_CELLS) & cloth.any(1))
    if len(rows) < MIN_CLOTH_ROWS:
        return None
    told = np.stack([np.median(colours[row][cloth[row]], 0) for row in rows])
    nearest = np.abs(rows[None] - np.arange(rows[-1] + 1)[:, None]).argmin(1)
    return np.asarray(cv2.GaussianBlur(told[nearest].astype(np.float32), (1, 9), 1), np.float32).reshape(-1, 3)


def _hair(
    colours: NDArray[np.float32], kinds: _Kinds, facing: NDArray[np.float32], streaks: NDArray[np.float32]
) -> NDArray[np.float32]:
    """Hair, or a hat, all round (A, `UNROLLED_COLUMNS`, 3)."""
    inner = cv2.erode(kinds.hair.astype(np.uint8), np.ones((HAIR_MARGIN_CELLS, HAIR_MARGIN_CELLS), np.uint8)) > 0
    sure = inner if inner.sum() > MIN_COLOUR_CELLS else kinds.hair
    turns = row_middles(facing)
    seen, near, own = (turned_rows(each, -turns) for each in (colours, np.maximum(facing, 0), sure))
    model = row_model(seen, own * near * (CENTRE_WEIGHT + COLUMN_SINES**2)).colours
    model = smoothed_rows(model, HAIR_SMOOTHING_METRES) + strand_levels(seen, own) * streaks[..., None]
    return joined(turned_rows(model, turns), colours, kinds.known, sure.astype(np.float32))


def _soft(mask: NDArray[np.bool_]) -> NDArray[np.float32]:
    return np.asarray(cv2.GaussianBlur(mask.astype(np.float32), (0, 0), EDGE_METRES / ROW_METRES), np.float32)[
        ..., None
    ]
