"""Exposures that drift while a film runs: a gain for each frame and channel, so that frames agree where they show the same.

Source of the model: the gains of M. Brown, D. G. Lowe, Automatic panoramic image stitching using invariant features, IJCV 2007,
section 6, in logarithms, and robust (Cauchy's weights), since what frames show differs for other reasons, too.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.avatar.texture.view_samples import ViewSamples

MIN_GREY_LEVEL, MAX_GREY_LEVEL = 12.0, 245.0
"""Grey levels, means along an edge, beyond which nothing is learnt: noise, and what is blown out."""
MAX_COMPARED_EDGES = 6000
"""Edges that are asked, evenly spread over all: each shows it in many frames."""
GAIN_REWEIGHTING_ROUNDS = 6
"""How often frames that disagree are weighted less and the gains found anew."""
CAUCHY_SCALE = 0.05
"""Difference of logarithms from which two frames are thought to show other things."""
PRIOR_WEIGHT = 1e-3
"""Of a gain's being 1, against all that a frame shows: for frames that share nothing with others."""


def exposure_gains(samples: ViewSamples) -> NDArray[np.float32]:
    """(N, 3) what each frame's colours are multiplied by so that they agree; of mean 1 in logarithms. Frames that show no
    edge that another shows keep 1."""
    seen = samples.cosine > 0
    asked = np.arange(0, len(samples.pairs), max(len(samples.pairs) // MAX_COMPARED_EDGES, 1))
    shown = seen[samples.pairs[asked]].all(1)
    gains = np.ones((shown.shape[1], 3), np.float32)
    for channel in range(3):
        means = samples.colours[asked, :, :, channel].mean(2, dtype=np.float32)
        used = shown & (means > MIN_GREY_LEVEL) & (means < MAX_GREY_LEVEL)
        used &= used.sum(1, keepdims=True) > 1
        if not used.any():
            continue
        gains[:, channel] = np.exp(-_offsets(np.log(np.maximum(means, 1)), used, samples.lengths[asked]))
    return gains


def _offsets(values: NDArray[np.float32], used: NDArray[np.bool_], lengths: NDArray[np.float64]) -> NDArray[np.float64]:
    """(N,) by how much the `values` (E, N) of each frame lie above what the frames agree on, where they are `used`."""
    base = used * (lengths / lengths.mean())[:, None]
    weights = base
    offsets = np.zeros(values.shape[1])
    for _ in range(GAIN_REWEIGHTING_ROUNDS):
        total = np.maximum(weights.sum(1), 1e-12)
        # each edge's own colour is its mean over the frames, and so drops out of the normal equations
        shared = weights / total[:, None]
        matrix = np.diag(weights.sum(0)) - weights.T @ shared
        mean = (weights * values).sum(1) / total
        right = (weights * (values - mean[:, None])).sum(0)
        # one offset for all changes nothing: what holds it is a mean of 0
        matrix += PRIOR_WEIGHT * np.diag(np.maximum(base.sum(0), 1)) + weights.sum() / len(offsets) ** 2
        offsets = np.linalg.solve(matrix, right)
        offsets -= offsets.mean()
        agreed = (weights * (values - offsets)).sum(1) / total
        away = values - offsets - agreed[:, None]
        weights = base / (1 + (away / CAUCHY_SCALE) ** 2)
    return offsets
