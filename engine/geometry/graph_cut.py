"""Labels for pixels or triangles, as they fit each and as neighbours agree: energies minimised by graph cuts.

Source: Y. Boykov, O. Veksler, R. Zabih, Fast approximate energy minimization via graph cuts, PAMI 2001 (expansion moves);
V. Kolmogorov, R. Zabih, What energy functions can be minimized via graph cuts?, PAMI 2004 (how a move becomes a graph).

Flows are SciPy's. Labels of 39,760 triangles out of 75 views take 21 s on two cores that others use as well
(`benchmarks/engine_figures/graph_cut.py`), 11 s of it in 495 flows. ortools was three times as fast on a grid, which
would save a third. It is 80 MB, and not used.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import breadth_first_order, maximum_flow

MAX_INTEGER_COST = 1 << 22
"""The largest cost of a graph in whole numbers: flows are computed in these."""


PairCost = Callable[[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]], NDArray[np.floating]]
"""What labels cost side by side: `cost(which, first, second)` are the costs (n,) >= 0 of the edges numbered `which` (n,) when
their ends, in the order of `edges`, have the labels `first` and `second` (n,). It is asked for different labels alone: equal
ones cost nothing."""


@dataclass(frozen=True)
class Labelling:
    """`labels` (N,), and the `energy` that they have. `truncated` counts, over all moves, edges whose costs did not
    keep to the triangle inequality, cost(a, b) <= cost(a, c) + cost(c, b). They were taken for larger in that move.
    Where it is 0 the bounds of Boykov, Veksler and Zabih hold."""

    labels: NDArray[np.intp]
    energy: float
    truncated: int


def alpha_expansion(
    unary: NDArray[np.floating],
    edges: NDArray[np.integer],
    weights: NDArray[np.floating],
    labels: NDArray[np.integer],
    sweeps: int = 4,
) -> NDArray[np.intp]:
    """Labels (N,) that make sum of unary[p, label p] + sum of weights[e] where the ends of edge e differ small.

    As `expansion_moves`, with `weights` (E,) >= 0: the Potts model. The result is within twice the best energy.
    """
    return expansion_moves(unary, edges, potts(weights), labels, sweeps).labels


def expansion_moves(
    unary: NDArray[np.floating],
    edges: NDArray[np.integer],
    pair_cost: PairCost,
    labels: NDArray[np.integer],
    sweeps: int = 4,
) -> Labelling:
    """Labels that make sum of unary[p, label p] + sum of the pairs' costs small.

    Parameters
    ----------
    unary : (N, L) cost of each label at each node; infinite where a node cannot have it.
    edges : (E, 2) neighbours, each pair once.
    pair_cost : any cost >= 0 of an edge and two labels, as the difference of two textures along a seam. Where it is a
        metric of the labels for each edge, a move is the best of all moves. In the end the energy is then at most 2 c
        times the least there is; c is the largest ratio of two costs of one edge. Other costs are taken for larger in
        a move where that is needed (C. Rother, S. Kumar, V. Kolmogorov, A. Blake, Digital tapestry, CVPR 2005): no move
        makes the energy rise.
    labels : (N,) to begin with. The result is never worse; with two labels it is the best there is.
    sweeps : most rounds over all labels; it ends when a round changes nothing.

    Raises ValueError where a node begins with a label that it cannot have.
    """
    current = np.asarray(labels, np.intp).copy()
    nodes, ends = np.arange(len(current)), np.asarray(edges, np.intp).reshape(-1, 2)
    if not np.isfinite(unary[nodes, current]).all():
        raise ValueError("a node begins with a label that it cannot have")
    pairs = _costs(pair_cost, np.arange(len(ends)), current[ends[:, 0]], current[ends[:, 1]])
    cost, truncated = _sum(unary, ends, pairs, current), 0
    settled: set[int] = set()  # the labels whose move changes nothing of what there is
    for _ in range(sweeps):
        before = cost
        for label in range(unary.shape[1]):
            if label in settled:
                continue
            takes, bent = _expansion(unary, ends, pair_cost, pairs, current, label)
            truncated += bent
            settled.add(label)
            if not takes.any():
                continue
            tried = np.where(takes, label, current)
            moved = np.flatnonzero(takes[ends].any(1))
            new = pairs.copy()
            new[moved] = _costs(pair_cost, moved, tried[ends[moved, 0]], tried[ends[moved, 1]])
            if (found := _sum(unary, ends, new, tried)) < cost:
                current, cost, pairs = tried, found, new
                settled = set() if bent else {label}  # what was the best move leaves none for its label
        if cost >= before:
            break
    return Labelling(current, cost, truncated)


def potts(weights: NDArray[np.floating]) -> PairCost:
    """The cost of an edge, (E,), whatever two labels differ there."""
    return lambda which, first, second: weights[which]


def energy(
    unary: NDArray[np.floating],
    edges: NDArray[np.integer],
    pairs: NDArray[np.floating] | PairCost,
    labels: NDArray[np.integer],
) -> float:
    """What is made small: by `alpha_expansion` with weights (E,) for `pairs`, by `expansion_moves` with costs."""
    ends, own = np.asarray(edges, np.intp).reshape(-1, 2), np.asarray(labels, np.intp)
    cost = pairs if callable(pairs) else potts(pairs)
    return _sum(unary, ends, _costs(cost, np.arange(len(ends)), own[ends[:, 0]], own[ends[:, 1]]), own)


def _sum(
    unary: NDArray[np.floating], ends: NDArray[np.intp], pairs: NDArray[np.float64], labels: NDArray[np.intp]
) -> float:
    differ = labels[ends[:, 0]] != labels[ends[:, 1]]
    return float(unary[np.arange(len(labels)), labels].sum() + pairs[differ].sum())


def _costs(
    pair_cost: PairCost, which: NDArray[np.intp], first: NDArray[np.intp], second: NDArray[np.intp]
) -> NDArray[np.float64]:
    """(n,) the costs of edges, nothing where both labels are equal."""
    out = np.zeros(len(which))
    differ = np.flatnonzero(first != second)
    if len(differ):
        out[differ] = pair_cost(which[differ], first[differ], second[differ])
    return out


def _expansion(
    unary: NDArray[np.floating],
    ends: NDArray[np.intp],
    pair_cost: PairCost,
    pairs: NDArray[np.float64],
    labels: NDArray[np.intp],
    label: int,
) -> tuple[NDArray[np.bool_], int]:
    """Who takes `label` in the best move in which each node either keeps its own or takes it: (N,); and for how many edges
    costs were truncated."""
    count = len(labels)
    free = np.isfinite(unary[:, label]) & (labels != label)
    takes = np.zeros(count, np.bool_)
    if not free.any():
        return takes, 0
    around = np.flatnonzero(free[ends].any(1))
    p, q = ends[around, 0], ends[around, 1]
    keep_both, every = pairs[around], np.full(len(around), label)
    only_q, only_p = _costs(pair_cost, around, labels[p], every), _costs(pair_cost, around, every, labels[q])
    between = only_q + only_p - keep_both
    # the cost of an edge is keep_both + (only_p - keep_both) p - only_p q + between (1 - p) q, where 1 is to take
    take = np.zeros(count)
    take[free] = unary[free, label] - unary[free, labels[free]]
    take = take + np.bincount(p, only_p - keep_both, count) - np.bincount(q, only_p, count)
    barred = ~free[p] & (labels[p] != label)  # p cannot take it: 1 - p is 1
    take = take + np.bincount(q[barred], between[barred], count)
    both = free[p] & free[q]
    p, q, between = p[both], q[both], between[both]
    wrong = between < -1e-9 * np.maximum(keep_both[both], 1e-9)
    number = np.cumsum(free) - 1
    keeps = _source_side(take[free], number[p], number[q], np.maximum(between, 0))
    takes[free] = ~keeps
    return takes, int(wrong.sum())


def _source_side(
    take: NDArray[np.float64], p: NDArray[np.intp], q: NDArray[np.intp], between: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """(n,) who stays with the source in the least cut of a graph. A node that leaves it costs `take` (n,), which may be
    negative. An edge of which q leaves and p stays costs `between` >= 0."""
    count = len(take)
    scale = MAX_INTEGER_COST / max(float(np.abs(take).max(initial=0)), float(between.max(initial=0)), 1e-12)
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
    return kept[:count]


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
