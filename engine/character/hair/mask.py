"""Which pixels show hair, a hat or a hood: what is above a face and is no skin, and what hangs from there beside it and down the body.

Hair, skin and clothes are told apart at once, by their colours: hair's are learned above the brow and beside the face off the template's head, skin's in
the face, and clothes' on the trunk. What has hair's colours and hangs from none is a collar, a hood on the shoulders or a clasp.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.hair.hanging import hanging
from engine.character.hair.regions import HeadRegions, TemplateHead, head_regions
from engine.imaging.masks.colour_segmentation import (
    MIN_MIXTURE_PIXELS,
    UNSEEDED_MARK,
    ColourMixture,
    ContrastGraph,
    colour_costs,
)
from engine.imaging.masks.mask_pieces import without_small_pieces

MIN_LOCK_SHARE = 0.12
"""Half the width of a lock of hair at least, as a share of half a face's width: a collar's edge is narrower."""
MIN_HAIR_PIECE_PIXELS = 30
"""Pixels of the grid of a piece of hair."""
HAIR, SKIN, CLOTH = 0, 1, 2
"""What pixels of a head, and of the body below it, are told to be."""
SEGMENTATION_ROUNDS = 3
"""How often mixtures and pixels are found anew from one another."""
UNUSUAL_COST, IMPOSSIBLE_COST = 2.0, 100.0
"""What costs, beside negative logarithms of densities, what is not usual: clothes on a head, hair on a body, skin above the brow beside the face. And
what cannot be: skin far off the template's head, clothes on it above the mouth."""
STRANGE_COST = 18.0
"""The negative logarithm of a density, levels to the minus third, that a colour has at most of all that is told apart. One that is nowhere else, as a
lining's, is what its surroundings are."""
USUAL_QUANTILE = 0.95
"""Quantile of how unlikely colours are among themselves, up to which others are like them."""
MAX_ALIKE_SHARE = 0.3
"""Share of the clothes that may be likelier hair, and is taken for it: of more, clothes have hair's colours, and nothing tells them apart."""
HAIR_COLOUR_VARIANCE = 20.0
"""Variance, levels squared, by which its colours differ with the light."""


def hair_mask(
    rgb: NDArray[np.uint8],
    head: NDArray[np.bool_],
    body: NDArray[np.bool_],
    template: TemplateHead,
) -> NDArray[np.bool_]:
    """The pixels (h, w) of a picture (h, w, 3) that show hair, a hat or a hood; none where nothing is off the template's head, or too little is seen.

    `head`, `body` (h, w): what is labelled as the head's, and as that of trunk and arms.
    """
    of, colours = head_regions(rgb, head, body, template), rgb.astype(np.float64)
    if of is None or min(int(one.sum()) for one in (of.bare, of.loose, of.roots, of.worn)) < MIN_MIXTURE_PIXELS:
        return np.zeros_like(head)
    worn, is_told = _clothes(colours, of)
    area = head | of.below if is_told else head
    surely = _sure_hair(colours, of, worn)
    seeds = np.where(of.bare, SKIN, np.where(surely, HAIR, UNSEEDED_MARK))[area]
    more = UNUSUAL_COST * np.stack([body, of.temples, head], 2)
    more[of.far, SKIN] = IMPOSSIBLE_COST
    more[template.covered & of.mouth, CLOTH] = IMPOSSIBLE_COST
    falls = (surely & ~of.brow).sum() >= MIN_HAIR_PIECE_PIXELS  # of other colours, where a hat is above it
    graph, pixels = ContrastGraph.of(colours, area), colours[area]
    hair, skin, cloth, told = surely, of.bare, worn, np.full(head.shape, UNSEEDED_MARK)
    for again in range(SEGMENTATION_ROUNDS):
        own = [hair & of.brow, hair & ~of.brow] if falls else [hair]
        of_hair = colour_costs([_mixture(colours[one]) for one in own if one.sum() >= MIN_MIXTURE_PIXELS], pixels)
        others = colour_costs([_mixture(colours[skin]), _mixture(colours[cloth])], pixels)
        costs = np.minimum(np.column_stack([of_hair.min(1), others]), STRANGE_COST) + more[area]
        told[area] = graph.cut(costs, told[area] if again else costs.argmin(1), seeds)
        hair = hanging((told == HAIR) & ~of.oval, of.roots)
        skin, cloth = ((told == SKIN) & template.covered) | of.bare, (told == CLOTH) | worn
    hair = hanging((told == HAIR) & ~of.oval, of.roots, of.ears)
    radius = max(1, round(MIN_LOCK_SHARE * float(template.face[2])))
    disk = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1, 2 * radius + 1))
    locks = cv2.morphologyEx(hair.astype(np.uint8), cv2.MORPH_OPEN, disk) > 0
    locks |= hair & of.mouth & head
    return hanging(without_small_pieces(locks, MIN_HAIR_PIECE_PIXELS), of.roots, of.ears)


def _mixture(colours: NDArray[np.float64]) -> ColourMixture:
    """The mixture of colours (N, 3) as they are in any light."""
    return ColourMixture.fit(colours).widened(HAIR_COLOUR_VARIANCE)


def _clothes(colours: NDArray[np.float64], of: HeadRegions) -> tuple[NDArray[np.bool_], bool]:
    """Where the trunk is surely in its clothes (h, w), without hair that falls over it, and whether they are told from hair at all."""
    hair, worn = _mixture(colours[hanging((of.loose & of.mouth) | of.roots, of.roots)]), of.worn
    for _ in range(SEGMENTATION_ROUNDS):
        costs = colour_costs([hair, _mixture(colours[worn])], colours[of.worn])
        worn = of.worn.copy()
        worn[of.worn] = costs[:, HAIR] > costs[:, 1]
        if worn.sum() < max((1 - MAX_ALIKE_SHARE) * of.worn.sum(), MIN_MIXTURE_PIXELS):
            return of.worn, False
    return worn, True


def _sure_hair(colours: NDArray[np.float64], of: HeadRegions, worn: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """What is loose above the mouth, unlike what is `worn` (h, w), and hangs from roots: (h, w)."""
    cloth, loose = _mixture(colours[worn]), of.loose & of.mouth
    most = np.quantile(cloth.negative_log_likelihood(colours[worn]), USUAL_QUANTILE)
    unlike = loose.copy()
    unlike[loose] = cloth.negative_log_likelihood(colours[loose]) > most
    return hanging(unlike | of.roots, of.roots)
