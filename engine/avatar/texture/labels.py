"""Which frame each face takes its colours from: the paper's equation 2, minimised by expansion moves.

Data weigh by a face's area and seams by their length, so that the finer parts of the mesh do not count for more. A frame's
share in a face is the cosine of the paper times how fine its pixels are there, as a part of the finest that any frame has: frames
of the head clip, filmed from near, win the head by themselves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from engine.avatar.texture.view_samples import ViewSamples
from engine.geometry.graph_cut import PairCost, expansion_moves

MAX_LABEL_VIEW_DEGREES = 45.0
"""Between a face's normal and the way to the camera up to which a frame is taken, as the paper has it."""
LABEL_SEAM_WEIGHT = 32.0
"""Of the seams against the data: colours are as near to the films as with 4, and steps at seams a third fewer."""
FRAMES_PER_FACE = 16
"""Best frames of a face among which it chooses, beside those that it begins with."""
EXPANSION_SWEEPS = 3
"""Rounds of expansions over all labels."""
UNSEEN_LABEL = -1
"""The label of a face that no frame shows."""


@dataclass(frozen=True)
class FaceLabels:
    """labels : (T,) int, the frame that each face takes, or `UNSEEN_LABEL`.
    data, seams : what the energy is made of, the latter not weighted.
    patches : connected pieces of one label.
    """

    labels: NDArray[np.intp]
    data: float
    seams: float
    patches: int


def best_views(samples: ViewSamples, gains: NDArray[np.floating], areas: NDArray[np.floating]) -> FaceLabels:
    """Each face by the frame that shows it best: where the paper begins. `gains` (N, 3), `areas` (T,)."""
    costs = _data_costs(samples, areas)
    labels = np.where(np.isfinite(costs).any(1), costs.argmin(1), UNSEEN_LABEL)
    return _measured(labels, costs, samples, gains)


def stitched(samples: ViewSamples, gains: NDArray[np.floating], areas: NDArray[np.floating]) -> FaceLabels:
    """Labels with few seams that are seen, by equation 2. Deterministic; never of more energy than `best_views`."""
    costs = _data_costs(samples, areas)
    known = np.flatnonzero(np.isfinite(costs).any(1))
    begin = costs.argmin(1)
    number = np.full(len(costs), -1)
    number[known] = np.arange(len(known))
    inner = np.flatnonzero((number[samples.pairs] >= 0).all(1))
    colour_cost = _seam_costs(samples, gains)
    found = expansion_moves(
        _pruned(costs[known]),
        number[samples.pairs[inner]],
        lambda which, first, second: LABEL_SEAM_WEIGHT * colour_cost(inner[which], first, second),
        begin[known],
        EXPANSION_SWEEPS,
    )
    labels = np.full(len(costs), UNSEEN_LABEL, np.intp)
    labels[known] = found.labels
    return _measured(labels, costs, samples, gains)


def _data_costs(samples: ViewSamples, areas: NDArray[np.floating]) -> NDArray[np.float32]:
    """(T, N): what each frame costs each face; infinite where it does not show it. Frames beyond `MAX_LABEL_VIEW_DEGREES` are taken by
    faces alone that no other shows."""
    cosine = samples.cosine
    near = cosine > np.cos(np.radians(MAX_LABEL_VIEW_DEGREES))
    allowed = np.where(near.any(1, keepdims=True), near, cosine > 0)
    density = np.where(allowed, samples.density, 0)
    finest = np.maximum(density.max(1, keepdims=True), 1e-12)
    share = cosine * density / finest
    return np.where(allowed, (1 - share) * (areas / areas.mean())[:, None], np.inf).astype(np.float32)


def _pruned(costs: NDArray[np.float32]) -> NDArray[np.float32]:
    """The costs with none but the `FRAMES_PER_FACE` least of each face finite."""
    if costs.shape[1] <= FRAMES_PER_FACE:
        return costs
    limit = np.partition(costs, FRAMES_PER_FACE - 1, 1)[:, FRAMES_PER_FACE - 1 : FRAMES_PER_FACE]
    return np.where(costs <= limit, costs, np.inf).astype(np.float32)


def _seam_costs(samples: ViewSamples, gains: NDArray[np.floating]) -> PairCost:
    """How far apart the colours of two frames are along an edge, in shares of the range, times its length."""
    lengths = samples.lengths / samples.lengths.mean()
    scale = np.asarray(gains, np.float32)

    def cost(which: NDArray[np.intp], first: NDArray[np.intp], second: NDArray[np.intp]) -> NDArray[np.floating]:
        one = samples.colours[which, first] * scale[first][:, None]
        other = samples.colours[which, second] * scale[second][:, None]
        return np.linalg.norm(one - other, axis=2).mean(1) / 255 * lengths[which]

    return cost


def _measured(
    labels: NDArray[np.intp], costs: NDArray[np.float32], samples: ViewSamples, gains: NDArray[np.floating]
) -> FaceLabels:
    known = labels != UNSEEN_LABEL
    pairs = samples.pairs
    inner = np.flatnonzero(known[pairs].all(1))
    alike = labels[pairs[inner, 0]] == labels[pairs[inner, 1]]
    same, differ = inner[alike], inner[~alike]
    seams = float(_seam_costs(samples, gains)(differ, labels[pairs[differ, 0]], labels[pairs[differ, 1]]).sum())
    data = float(costs[np.flatnonzero(known), labels[known]].sum())
    links = sp.csr_array((np.ones(len(same)), (pairs[same, 0], pairs[same, 1])), (len(labels), len(labels)))
    _, piece = connected_components(links, directed=False)
    return FaceLabels(labels, data, seams, len(np.unique(piece[known])))
