"""What a template says of the pixels of a head before colours do: where hair may be, skin and clothes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.character.figure.face_region import within_oval
from engine.imaging.masks.mask_distance import dilate_mask, distance_to
from engine.imaging.masks.mask_pieces import mask_height, pieces_touching

MOUTH_DEPTH_SHARE = 0.35
"""How far below a face's middle, as a share of half its height, what is narrow or loose may be a collar."""
SURELY_HAIR_SHARE = 0.06
"""How far off the template's head and neck, as a share of their height, nothing is skin: ears are nearer."""
LOOSE_HAIR_PIXELS = 2
"""Pixels of the grid off the template's head from which on hair is loose."""
FACE_SHARE, SKIN_SHARE = 0.92, 0.7
"""Share of a face's oval in which nothing is hair, and of that from which the colours of skin are learned."""
BROW_HEIGHT_SHARE = 0.25
"""How far above a face's middle, as a share of half its height, whatever is beside it is hair: there are no ears."""
FOREHEAD_SHARE = 1.05
"""How far above a face's middle its forehead ends, as a share of half its height: beyond is hair or a hat, but for skin that goes on from the face."""
MAX_SKIN_DISTANCE_LEVELS = 60.0
"""Levels from the face's median up to which a colour may be skin's."""
MAX_FAIR_SHARE = 0.2
"""Share of what is beside the template's head that may have the face's colours, for hair to be told from skin by its colour alone."""
SURE_CLOTH_SHARES = (1.2, 4.0)
"""Between which heights below the head, in half heights of the face, the trunk is surely in its clothes."""
FALLEN_HAIR_SHARE = 1.2
"""How far from the head hair is looked for on the body, in heights of the head and its neck."""
THROAT_SHARE = 0.4
"""Share of half a face's width to both sides of its middle in which no hair falls down the body."""


@dataclass(frozen=True)
class TemplateHead:
    """Where the template's head is in a picture.

    covered, ears : (h, w) bool, the pixels of head and neck, and of the ears among them.
    face : (5,), the ellipse around the face.
    """

    covered: NDArray[np.bool_]
    ears: NDArray[np.bool_]
    face: NDArray[np.floating]


@dataclass(frozen=True)
class HeadRegions:
    """Pixels (h, w) bool of a picture.

    oval : the face, in which nothing is hair.
    bare : surely skin.
    loose : too far off the template's head for skin, or off it and of another colour.
    far : so far off it that nothing is skin.
    brow, mouth : what is above them.
    temples : above the brow beside the face, where hair has the face's colours.
    roots : surely hair, a hat or a hood: above the forehead, or loose above the brow.
    ears : what is before hair that hangs behind it.
    worn : of the trunk, where it is surely in its clothes.
    below : of the body, where hair may fall: both sides of the throat.
    """

    oval: NDArray[np.bool_]
    bare: NDArray[np.bool_]
    loose: NDArray[np.bool_]
    far: NDArray[np.bool_]
    brow: NDArray[np.bool_]
    mouth: NDArray[np.bool_]
    temples: NDArray[np.bool_]
    roots: NDArray[np.bool_]
    ears: NDArray[np.bool_]
    worn: NDArray[np.bool_]
    below: NDArray[np.bool_]


def head_regions(
    rgb: NDArray[np.uint8],
    head: NDArray[np.bool_],
    body: NDArray[np.bool_],
    template: TemplateHead,
) -> HeadRegions | None:
    """The regions of a picture (h, w, 3); None where the face is hidden. `head`, `body` (h, w): what is labelled as the head's, and as that of trunk
    and arms."""
    covered, face = template.covered, template.face
    x, y, wide, high, _ = (float(value) for value in face)
    rows, columns = np.arange(len(head))[:, None], np.arange(head.shape[1])[None]
    oval, inner = (within_oval(face * [1, 1, share, share, 1], head.shape) for share in (FACE_SHARE, SKIN_SHARE))
    if not (inner & head).any() or not covered.any():
        return None
    colours, size = rgb.astype(np.float64), mask_height(covered)
    like_skin = np.abs(colours - np.median(colours[inner & head], 0)).max(-1) < MAX_SKIN_DISTANCE_LEVELS
    far = head & (distance_to(covered) > SURELY_HAIR_SHARE * size)
    off = head & ~dilate_mask(covered, LOOSE_HAIR_PIXELS) & ~like_skin
    brow, mouth, forehead = (
        np.broadcast_to(rows < y + share * high, head.shape)
        for share in (-BROW_HEIGHT_SHARE, MOUTH_DEPTH_SHARE, -FOREHEAD_SHARE)
    )
    beside = head & ~covered
    fair = beside.any() and like_skin[beside].mean() > MAX_FAIR_SHARE
    high_forehead = np.zeros_like(head) if fair else pieces_touching(head & covered & like_skin, inner)
    end = int(np.flatnonzero(covered.any(1))[-1])
    first, last = (end + share * high for share in SURE_CLOTH_SHARES)
    return HeadRegions(
        oval=oval,
        bare=inner & head & like_skin,
        loose=off | far,
        far=far,
        brow=brow,
        mouth=mouth,
        temples=brow & ~oval & bool(fair),
        roots=head & ((forehead & ~high_forehead) | (off & brow)),
        ears=head & ~oval & dilate_mask(template.ears, LOOSE_HAIR_PIXELS),
        worn=body & (rows > first) & (rows < last),
        below=body & (distance_to(head) < FALLEN_HAIR_SHARE * size) & (np.abs(columns - x) > THROAT_SHARE * wide),
    )
