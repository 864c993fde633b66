"""Collars, scarves and hoods that lie on the shoulders: what of the head's label below the mouth has the clothes' colours is the trunk's.

Labels end the head at the template's chin, however high a collar stands. Left with the head it would be hair, or a bare neck. Clothes are
learned where the trunk surely wears some, and skin also as dark as it is beneath a chin: a bare neck is no cloth.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from engine.character.figure.face_region import face_ellipse, within_oval
from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import Silhouette
from engine.character.hair.mask import HAIR_COLOUR_VARIANCE, SEGMENTATION_ROUNDS, STRANGE_COST, USUAL_QUANTILE
from engine.character.hair.regions import (
    BROW_HEIGHT_SHARE,
    FACE_SHARE,
    MOUTH_DEPTH_SHARE,
    SKIN_SHARE,
    SURE_CLOTH_SHARES,
)
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import HEAD_LABEL, TRUNK_LABEL
from engine.imaging.masks.colour_segmentation import (
    MIN_MIXTURE_PIXELS,
    UNSEEDED_MARK,
    ColourMixture,
    ContrastGraph,
    colour_costs,
)
from engine.imaging.masks.mask_pieces import pieces_touching, without_small_pieces

CLOTH_REACH_SHARE = 1.2
"""How far below the head's label cloth is told from what is bare, in half heights of the face."""
SHADES = tuple(np.linspace(1.0, 0.4, 13))
"""How light skin may be beneath a chin, as shares of the face's."""
MIN_CLOTH_PIECE_PIXELS = 12
"""Pixels of the grid of a piece of cloth that is worth having."""
MIN_HAIR_BESIDE_SHARE = 0.4
"""Share of what is beside a face, between eyes and mouth, that is no skin, from which on it is hair, and may come down to the shoulders."""
EARS_DEPTH_SHARE, MAX_CLOTH_BESIDE_SHARE = 0.15, 0.3
"""How far below a face's middle ears are, as a share of half its height, and the share of what is beside it down to there that may have the clothes'
colours: of more, what was taken for clothes is hair."""


def with_neck_cloth(figure: Figure, silhouette: Silhouette, labels: Labels) -> Labels:
    """Labels whose trunk has the cloth that stands up around the neck. As they were where no face is found, or clothes have the colours of skin
    or of hair."""
    cloth = neck_cloth(
        silhouette.rgb,
        labels.labels == HEAD_LABEL,
        labels.labels == TRUNK_LABEL,
        face_ellipse(figure, silhouette.to_grid, labels.labels == HEAD_LABEL),
    )
    return replace(labels, labels=np.where(cloth, TRUNK_LABEL, labels.labels).astype(labels.labels.dtype))


def _between(rows: NDArray[np.integer], first: float, last: float) -> NDArray[np.bool_]:
    return np.asarray((rows > first) & (rows < last), np.bool_)


def neck_cloth(
    rgb: NDArray[np.uint8],
    head: NDArray[np.bool_],
    trunk: NDArray[np.bool_],
    face: NDArray[np.floating] | None,
) -> NDArray[np.bool_]:
    """The pixels (h, w) of a `head` (h, w) below its mouth that are like the `trunk`'s clothes (h, w) and hang together with them. `face` (5,):
    the ellipse around it."""
    nothing = np.zeros(head.shape, np.bool_)
    if face is None:
        return nothing
    rows = np.arange(len(head))[:, None]
    oval, inner = (within_oval(face * [1, 1, share, share, 1], head.shape) for share in (FACE_SHARE, SKIN_SHARE))
    low = head & ~oval & np.asarray(rows > face[1] + MOUTH_DEPTH_SHARE * face[3], np.bool_)
    last = int(np.flatnonzero(head.any(1))[-1]) if head.any() else 0
    near = trunk & (rows < last + CLOTH_REACH_SHARE * face[3])
    crown = head & ~oval & (rows < face[1] - BROW_HEIGHT_SHARE * face[3])
    colours = rgb.astype(np.float64)
    if min(int(one.sum()) for one in (low, near, crown, inner & head)) < MIN_MIXTURE_PIXELS:
        return nothing
    skin = ColourMixture.fit(colours[inner & head]).widened(HAIR_COLOUR_VARIANCE)
    usual = float(np.quantile(skin.negative_log_likelihood(colours[inner & head]), USUAL_QUANTILE))
    beside = np.asarray(head & ~oval & ~low & (rows > face[1]), np.bool_)
    no_skin = np.zeros(head.shape, np.bool_)
    no_skin[beside] = skin.negative_log_likelihood(colours[beside]) > usual
    shades = np.concatenate([shade * colours[inner & head] for shade in SHADES])
    bare = [ColourMixture.fit(shades).widened(HAIR_COLOUR_VARIANCE)]
    if no_skin.sum() > MIN_HAIR_BESIDE_SHARE * beside.sum():  # else none comes down to the shoulders
        bare.append(ColourMixture.fit(colours[np.asarray(crown, np.bool_) | no_skin]).widened(HAIR_COLOUR_VARIANCE))
    area, cloth_number = np.asarray(low | near, np.bool_), len(bare)
    graph, pixels = ContrastGraph.of(colours, area), colours[area]
    costs = np.minimum(colour_costs(bare, pixels), STRANGE_COST)
    surely = trunk & _between(rows, *(last + share * face[3] for share in SURE_CLOTH_SHARES))
    if surely.sum() < MIN_MIXTURE_PIXELS:
        return nothing
    worn = ColourMixture.fit(colours[surely]).widened(HAIR_COLOUR_VARIANCE)
    other = np.minimum(worn.negative_log_likelihood(pixels), STRANGE_COST)
    found = np.where(costs.min(1) < other, costs.argmin(1), cloth_number)
    seeds = np.full(len(pixels), UNSEEDED_MARK)
    for _ in range(SEGMENTATION_ROUNDS):
        of_cloth = np.concatenate([pixels[(found == cloth_number) & near[area]], colours[surely]])
        cloth = ColourMixture.fit(of_cloth).widened(HAIR_COLOUR_VARIANCE)
        other = np.minimum(cloth.negative_log_likelihood(pixels), STRANGE_COST)
        found = graph.cut(np.concatenate([costs, other[:, None]], 1), found, seeds)
    at_ears = beside & np.asarray(rows < face[1] + EARS_DEPTH_SHARE * face[3], np.bool_)
    like_cloth = cloth.negative_log_likelihood(colours[at_ears]) < colour_costs(bare, colours[at_ears]).min(1)
    if like_cloth.sum() > MAX_CLOTH_BESIDE_SHARE * at_ears.sum():
        return nothing
    of_clothes = nothing.copy()
    of_clothes[area] = found == cloth_number
    joined = pieces_touching(of_clothes | trunk, trunk) & of_clothes & low
    return without_small_pieces(joined, MIN_CLOTH_PIECE_PIXELS)
