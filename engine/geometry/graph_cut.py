"""Labels for pixels, as they fit each and as neighbours agree: energies minimised by graph cuts.

Source: Y. Boykov, O. Veksler, R. Zabih, Fast approximate energy minimization via graph cuts, PAMI 2001 (expansion moves);
V. Kolmogorov, R. Zabih, What energy functions can be minimized via graph cuts?, PAMI 2004 (how a move becomes a graph).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import breadth_first_order, maximum_flow

STEPS = 1 << 22
"""The largest cost of a graph in whole numbers: flows are computed in these."""


def alpha_expansion(
    unary: NDArray[np.floating],
    edges: NDArray[np.integer],
    weights: NDArray[np.floating],
    labels: NDArray[np.integer],
    sweeps: int = 4,
) -> NDArray[np.intp]:
    """Labels (N,) that make sum of unary[p, label p] + sum of weights[e] where the ends of edge e differ small.

    Parameters
    ----------
    unary : (N, L) cost of each label at each node.
    edges : (E, 2) neighbours, each pair once. `weights` (E,) >= 0: the Potts model.
    labels : (N,) to begin with. The result is never worse; with two labels it is the best there is.
    sweeps : most rounds over all labels; it ends when a round changes nothing.
    """
    current = np.asarray(labels, np.intp).copy()
    cost = energy(unary, edges, weights, current)
    for _ in range(sweeps):
        before = cost
        for label in range(unary.shape[1]):
            tried = np.where(_expansion(unary, edges, weights, current, label), label, current)
            if (found := energy(unary, edges, weights, tried)) < cost:
                current, cost = tried, found
        if cost >= before:
            break
    return current


def energy(
    unary: NDArray[np.floating],
    edges: NDArray[np.integer],
    weights: NDArray[np.floating],
    labels: NDArray[np.integer],
) -> float:
    """What `alpha_expansion` makes small."""
    differ = labels[edges[:, 0]] != labels[edges[:, 1]]
    return float(unary[np.arange(len(labels)), labels].sum() + weights[differ].sum())


def _expansion(
    unary: NDArray[np.floating],
    edges: NDArray[np.integer],
    weights: NDArray[np.floating],
    labels: NDArray[np.intp],
    label: int,
) -> NDArray[np.bool_]:
    """Who takes `label` in the best move in which each node either keeps its own or takes it: (N,)."""
    count = len(labels)
    take = unary[:, label] - unary[np.arange(count), labels]
    p, q = edges[:, 0], edges[:, 1]
    keep_both = weights * (labels[p] != labels[q])
    only_q, only_p = weights * (labels[p] != label), weights * (labels[q] != label)
    take = take + np.bincount(p, only_p - keep_both, count) - np.bincount(q, only_p, count)
    between = only_q + only_p - keep_both
    scale = STEPS / max(float(np.abs(take).max(initial=0)), float(between.max(initial=0)), 1e-12)
    source, sink = count, count + 1
    nodes = np.arange(count)
    rows = np.concatenate([np.full(count, source), nodes, p])
    columns = np.concatenate([nodes, np.full(count, sink), q])
    capacities = np.concatenate([np.maximum(take, 0), np.maximum(-take, 0), between]) * scale
    graph = sp.csr_array((np.round(capacities).astype(np.int32), (rows, columns)), (count + 2, count + 2))
    graph.eliminate_zeros()
    rest: Any = graph - maximum_flow(graph, source, sink).flow
    rest.data = (rest.data > 0).astype(np.int32)
    rest.eliminate_zeros()
    kept = np.zeros(count + 2, np.bool_)
    kept[breadth_first_order(rest, source, return_predecessors=False)] = True
    return ~kept[:count]


def grid_edges(mask: NDArray[np.bool_]) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """The pairs of 8-neighbours within a mask (H, W), as numbers of its pixels in reading order, (E, 2), and how far
    apart they are, (E,)."""
    index = np.full(mask.shape, -1, np.intp)
    index[mask] = np.arange(int(mask.sum()))
    pairs, lengths = [], []
    height, width = mask.shape
    for dy, dx in ((0, 1), (1, 0), (1, 1), (1, -1)):
        first = index[: height - dy, max(-dx, 0) : width - max(dx, 0)]
        second = index[dy:, max(dx, 0) : width + min(dx, 0)]
        both = (first >= 0) & (second >= 0)
        pairs.append(np.stack([first[both], second[both]], 1))
        lengths.append(np.full(int(both.sum()), np.hypot(dy, dx)))
    return np.concatenate(pairs), np.concatenate(lengths)
