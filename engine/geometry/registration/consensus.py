"""A similarity on which many pairs of points agree, although others are anywhere.

Source: M. A. Fischler, R. C. Bolles, Random sample consensus, Communications of the ACM 24, 1981. Pairs agree where they lie near
each other in both worlds: by the destination's distances alone, everything could be shrunk onto a spot where many points
lie.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.rigid import Similarity, fit_similarity

PAIRS_PER_SAMPLE = 3
"""Pairs that make a similarity of space."""
CONSENSUS_SAMPLES = 1000
"""Samples: with a third of the pairs right, one of all right ones is missed once in 10 to the 16."""
REFINEMENT_ROUNDS = 5
"""Fits to all pairs that agree, one after the other."""


@dataclass(frozen=True)
class Consensus:
    """The `transform` from source to destination, and which pairs (N,) bool `agreed` on it."""

    transform: Similarity
    agreed: NDArray[np.bool_]


def similarity_by_consensus(
    source: NDArray[np.floating], destination: NDArray[np.floating], tolerance: float, seed: int = 0
) -> Consensus | None:
    """The similarity on which most pairs (N, 3) agree; None where there are fewer than three, or no three make one.

    tolerance : by which pairs that agree may be apart, in the destination's unit; in the source's it is as much smaller or
        larger as the source's points are spread less or more.
    """
    if len(source) < PAIRS_PER_SAMPLE:
        return None
    a, b = np.asarray(source, np.float64), np.asarray(destination, np.float64)
    within = tolerance, tolerance * _spread(a) / max(_spread(b), 1e-300)
    random = np.random.default_rng(seed)
    best: Consensus | None = None
    for _ in range(CONSENSUS_SAMPLES):
        chosen = random.choice(len(a), PAIRS_PER_SAMPLE, replace=False)
        found = _judged(a, b, chosen, within)
        if found is not None and (best is None or found.agreed.sum() > best.agreed.sum()):
            best = found
    for _ in range(REFINEMENT_ROUNDS):
        if best is None or best.agreed.sum() < PAIRS_PER_SAMPLE:
            return None
        refined = _judged(a, b, np.flatnonzero(best.agreed), within)
        if refined is None or refined.agreed.sum() < best.agreed.sum():
            break
        best = refined
    return best


def _judged(
    a: NDArray[np.float64], b: NDArray[np.float64], chosen: NDArray[np.intp], within: tuple[float, float]
) -> Consensus | None:
    """The similarity of the chosen pairs with the pairs that agree on it; None where they lie in one place."""
    if np.ptp(a[chosen], axis=0).max() == 0:
        return None
    transform = fit_similarity(a[chosen], b[chosen])
    if not np.isfinite(transform.linear).all() or transform.scale < 1e-12:
        return None
    there = np.linalg.norm(transform(a) - b, axis=1) < within[0]
    back = np.linalg.norm(transform.inverse()(b) - a, axis=1) < within[1]
    return Consensus(transform, there & back)


def _spread(points: NDArray[np.float64]) -> float:
    """The distance of points from their middle that four of five do not pass: neither a crowd nor a stray point rules it."""
    return float(np.percentile(np.linalg.norm(points - np.median(points, axis=0), axis=1), 80))
