"""Hair on the unrolled head: where it begins, and its strands.

What the picture shows of a hairline is followed to where it ends. Behind that, hair begins as on heads: before the ear
and down to the nape. Strands are noise drawn out along them, as strong as what is fine about the hair that is seen:
what a picture shows of the front, laid behind, is a second face of hair.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.shell.colours.head_map import HeadMap
from engine.character.shell.colours.seam_path import cheapest_path, sides_cost
from engine.character.shell.colours.unrolled import ROW_METRES, UNROLLED_COLUMNS
from engine.imaging.filling.nearest import nearest_in

HAIR_EDGE_RADIANS = {
    "nape": 2.45,
    "nose": 2.05,
    "ears": 1.28,
    "eyes": 1.22,
    "brow": 1.14,
    "forehead": 0.95,
    "crown": 0.0,
}
"""Radians from the face's middle beyond which hair is, by the height: behind the ear, before it in sideburns, and at the temple."""
LONG_HAIR_EDGE_RADIANS = 1.3
"""Radians from the face's middle beyond which hair that falls over the ears is, at most."""
MIN_EDGE_RADIANS = 0.45
"""Radians from the face's middle from which on a hairline is looked for."""
TOLD_COSINES = (0.3, 0.75)
"""Cosines to the viewer from which on what is seen tells where hair begins, and from which on it does so wholly."""
USUAL_HAIRLINE_WEIGHT, UNSEEN_HAIRLINE_WEIGHT = 0.04, 0.3
"""How much a cell of the way to where hair begins on heads counts beside one that is well seen and on the wrong side: above the ears, and below
them, where nothing tells."""
NO_HAIRLINE_COST = 10.0
"""What a cell costs in the middle of the face that would be behind the hairline."""
HAIRLINE_STEP_CELLS, HAIRLINE_STEP_COST, HAIRLINE_SMOOTHING_ROWS = 6, 0.25, 3.0
"""Cells by which a hairline moves at most from row to row, what each costs, and rows over which it is averaged."""
FULL_HAIR_CROWN_SHARE = 0.7
"""Share of the way from the hairline to the crown above which hair is all round."""
UNEVENNESS_RADIANS, UNEVENNESS_ROWS = 0.04, 0.8
"""By how much hair begins unevenly, and ends at the nape: standard deviation."""
STRAND_SCALES = ((0.7, 7.0, 0.8), (2.5, 14.0, 0.6))
"""Columns and rows over which strands are alike, and how much of them is so: single ones, and locks."""
WAVE_CELLS, WAVE_COLUMNS = 18.0, 4.0
"""Cells over which strands bend, and columns by which they do: standard deviation."""
FINE_CELLS = 4.0
"""Cells over which what is fine about hair averages out."""
MAX_STRAND_LEVELS = 12.0
"""Standard deviation of strands, sRGB levels, at most."""
MIN_STRAND_CELLS = 50
"""Cells of hair that tell how strong strands are."""


@dataclass(frozen=True)
class HeadSeen:
    """What is seen of a head, (A, `UNROLLED_COLUMNS`) each.

    known : bool, all of it.
    hair : bool, what of it is hair.
    facing : float32, cosine to the viewer.
    """

    known: NDArray[np.bool_]
    hair: NDArray[np.bool_]
    facing: NDArray[np.float32]


def hair_share(
    head: HeadMap, begins: NDArray[np.float32], seen: HeadSeen, streaks: NDArray[np.float32], *, falls: bool
) -> NDArray[np.bool_]:
    """The cells (A, `UNROLLED_COLUMNS`) of hair, which `begins` at so many radians (A, `UNROLLED_COLUMNS`) from the face's middle. `streaks`:
    of `strand_noise`; hair that `falls` covers ears and neck."""
    covered = head.angle > begins + UNEVENNESS_RADIANS * streaks
    if seen.hair.any():  # above the forehead as the nearest that is seen is
        wide, of_hair = (np.concatenate([each, each, each], 1) for each in (seen.known, seen.hair))
        y, x = nearest_in(wide)
        nearest = of_hair[y, x][:, UNROLLED_COLUMNS : 2 * UNROLLED_COLUMNS]
        covered = np.where(head.above("hairline") & ~covered, nearest, covered)
    line, crown = head.levels["hairline"], head.levels["crown"]
    covered = covered | (head.height > line + FULL_HAIR_CROWN_SHARE * (crown - line))
    if not falls:
        covered &= head.height > head.levels["nape"] + UNEVENNESS_ROWS * streaks
    return np.asarray(covered, np.bool_)


def hairline(head: HeadMap, seen: HeadSeen, *, falls: bool) -> NDArray[np.float32]:
    """Radians from the face's middle (A, `UNROLLED_COLUMNS`) at which hair begins, on each side its own: a line that runs down from the
    forehead to before the ear without a step, and has before it as little hair, and behind it as little skin, as it may. What is seen at a slant
    counts little."""
    names = sorted(HAIR_EDGE_RADIANS, key=lambda name: head.levels[name])
    most = LONG_HAIR_EDGE_RADIANS if falls else np.inf
    usual = np.interp(
        head.height[:, 0],
        [head.levels[name] for name in names],
        [min(HAIR_EDGE_RADIANS[name], most) for name in names],
    ).astype(np.float32)
    half = UNROLLED_COLUMNS // 2
    aside = head.angle[0, half:]
    wide = float(aside[1] - aside[0])
    least, all_ = TOLD_COSINES
    weight = seen.known * np.clip((seen.facing - least) / (all_ - least), 0, 1) * ~head.around_ears * head.above("ears")
    trust = np.where(head.above("ears"), USUAL_HAIRLINE_WEIGHT, UNSEEN_HAIRLINE_WEIGHT)
    far = trust * np.abs(aside - usual[:, None]) / wide
    found = np.empty((len(usual), 2), np.float32)
    for side, columns in enumerate((slice(half - 1, None, -1), slice(half, None))):  # from the face's middle outwards
        told, hair, bare = weight[:, columns], seen.hair[:, columns], aside < MIN_EDGE_RADIANS
        before = told * hair * ~bare
        behind = told * ~hair + NO_HAIRLINE_COST * bare
        cost = sides_cost(before, behind, far)[:, :-1]  # hair begins somewhere
        line = cheapest_path(cost, HAIRLINE_STEP_CELLS, HAIRLINE_STEP_COST)
        found[:, side] = wide * line
    smooth = cv2.GaussianBlur(found, (1, 0), 1, sigmaY=HAIRLINE_SMOOTHING_ROWS)
    return np.repeat(np.asarray(smooth, np.float32), half, 1)


def strand_noise(shape: tuple[int, int]) -> NDArray[np.float32]:
    """Noise (A, `UNROLLED_COLUMNS`) drawn out along strands that fall from the crown, of mean 0 and deviation 1; always the same, and
    going on across the ends of rows."""
    random = np.random.default_rng(0)
    rows, columns = shape
    white = random.standard_normal((rows, columns)).astype(np.float32)
    wide = np.concatenate([white, white, white], 1)
    streaks = np.zeros_like(wide)
    for across, along, share in STRAND_SCALES:
        drawn = cv2.GaussianBlur(wide, (0, 0), sigmaX=across, sigmaY=along)
        streaks += share * drawn / drawn.std()
    white = random.standard_normal((rows, columns)).astype(np.float32)
    bends = np.asarray(cv2.GaussianBlur(np.concatenate([white, white, white], 1), (0, 0), WAVE_CELLS), np.float32)
    y, x = np.mgrid[0:rows, 0 : 3 * columns].astype(np.float32)
    waved = cv2.remap(streaks, x + WAVE_COLUMNS * bends / bends.std(), y, cv2.INTER_LINEAR)
    own = waved[:, columns : 2 * columns]
    return np.asarray((own - own.mean()) / own.std(), np.float32)


def strand_levels(colours: NDArray[np.floating], hair: NDArray[np.bool_]) -> float:
    """How strong strands are, sRGB levels: the deviation of what is fine about the `hair` (A, `UNROLLED_COLUMNS`) of `colours` (A,
    `UNROLLED_COLUMNS`, 3), told by its median: a parting or a comb is no strand."""
    light = colours.mean(-1).astype(np.float32)
    whole = cv2.erode(hair.astype(np.uint8), np.ones((3, 3), np.uint8)).astype(np.float32)
    around = np.maximum(cv2.GaussianBlur(whole, (0, 0), FINE_CELLS), 1e-3)
    fine = (light - cv2.GaussianBlur(light * whole, (0, 0), FINE_CELLS) / around)[whole > 0]
    if len(fine) < MIN_STRAND_CELLS:
        return 0.0
    return float(min(1.4826 * np.median(np.abs(fine - np.median(fine))), MAX_STRAND_LEVELS))


def smoothed_rows(colours: NDArray[np.floating], metres: float) -> NDArray[np.float32]:
    """Colours (A, `UNROLLED_COLUMNS`, 3) averaged over rows: what lies across hair are lights on it."""
    flat = np.ascontiguousarray(colours.reshape(len(colours), -1), np.float32)
    blurred = cv2.GaussianBlur(flat, (1, 0), 1, sigmaY=metres / ROW_METRES, borderType=cv2.BORDER_REPLICATE)
    return np.asarray(blurred, np.float32).reshape(colours.shape)
