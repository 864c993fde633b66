"""Areas of a picture told apart by their colours: Gaussian mixtures, likelihoods, and cuts that follow contrast.

Sources: Y. Boykov, M.-P. Jolly, "Interactive graph cuts for optimal boundary and region segmentation of objects", ICCV 2001
(seeds, cuts); C. Rother, V. Kolmogorov, A. Blake, "GrabCut", SIGGRAPH 2004 (mixtures of colours, weights by contrast).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.geometry.graph_cut import alpha_expansion, grid_edges

MIXTURE_GAUSSIANS = 5
"""Gaussians in a mixture: the K of GrabCut."""
MIN_MIXTURE_PIXELS = 10 * MIXTURE_GAUSSIANS
"""Pixels of which a mixture says something about their area."""
MAX_SAMPLE_PIXELS = 1500
"""Pixels, evenly spread, from which a mixture is found."""
MIN_VARIANCE = 1.0
"""Levels squared that are added to each Gaussian's variances: one of a single colour has a density, too."""
MIN_DENSITY = 1e-30
"""The probability density below which all colours are equally unlikely."""
SMOOTHNESS_COST = 8.0
"""What it costs where the labels of two neighbours of one colour differ, beside negative logarithms of densities."""
SEED_COST = 1e3
"""What it costs to give a seed another label: more than all its neighbours together."""
UNSEEDED_MARK = -1
"""The seed of a pixel that has none."""


@dataclass(frozen=True)
class ColourMixture:
    """A mixture of K Gaussians over colours.

    weights : (K,), which sum to one but for clusters that were too small.
    means : (K, 3), in levels.
    covariances : (K, 3, 3), in levels squared.
    """

    weights: NDArray[np.float64]
    means: NDArray[np.float64]
    covariances: NDArray[np.float64]

    @classmethod
    def fit(cls, colours: NDArray[np.floating]) -> ColourMixture:
        """The mixture of some colours (N, 3), found as GrabCut does: they are clustered, and each cluster is a Gaussian.

        Raises ValueError if there are fewer than `MIN_MIXTURE_PIXELS`.
        """
        if len(colours) < MIN_MIXTURE_PIXELS:
            raise ValueError(f"{len(colours)} colours are too few for a mixture of {MIXTURE_GAUSSIANS}")
        some = np.ascontiguousarray(colours[:: max(1, len(colours) // MAX_SAMPLE_PIXELS)], np.float32)
        criteria = (cv2.TERM_CRITERIA_COUNT, 10, 0.0)
        cv2.setRNGSeed(1)
        _, cluster, _ = cv2.kmeans(some, MIXTURE_GAUSSIANS, np.empty(0, np.int32), criteria, 1, cv2.KMEANS_PP_CENTERS)
        clusters = [some[cluster.ravel() == k].astype(np.float64) for k in range(MIXTURE_GAUSSIANS)]
        clusters = [own for own in clusters if len(own) > 3]  # fewer have no volume
        return cls(
            np.array([len(own) / len(some) for own in clusters]),
            np.stack([own.mean(0) for own in clusters]),
            np.stack([np.cov(own.T) + MIN_VARIANCE * np.eye(3) for own in clusters]),
        )

    def widened(self, variance: float) -> ColourMixture:
        """The mixture with so much more variance, levels squared: the same matter in another light."""
        return replace(self, covariances=self.covariances + variance * np.eye(3))

    def negative_log_likelihood(self, colours: NDArray[np.floating]) -> NDArray[np.float64]:
        """Minus the logarithm of the density at some colours (N, 3), per level cubed: (N,)."""
        density = np.zeros(len(colours))
        for weight, mean, covariance in zip(self.weights, self.means, self.covariances, strict=True):
            inverse = np.linalg.inv(covariance)
            off = colours - mean
            exponent = -0.5 * np.einsum("ni,ni->n", off @ inverse, off)
            density += weight * np.exp(exponent) * np.sqrt(np.linalg.det(inverse) / (2 * np.pi) ** 3)
        return np.asarray(-np.log(np.maximum(density, MIN_DENSITY)))


def colour_costs(mixtures: Sequence[ColourMixture], colours: NDArray[np.floating]) -> NDArray[np.float64]:
    """The cost (N, L) of giving each of some colours (N, 3) to each of L mixtures: negative log-likelihoods."""
    return np.stack([mixture.negative_log_likelihood(colours) for mixture in mixtures], 1)


def smoothed_map(values: NDArray[np.floating], area: NDArray[np.bool_], sigma: float) -> NDArray[np.float32]:
    """Values (N,) of the N pixels of an area (H, W), in reading order, as a map (H, W), 0 elsewhere, blurred by a Gaussian of
    `sigma` pixels: a pixel goes by its neighbours, too."""
    on_grid = np.zeros(area.shape, np.float32)
    on_grid[area] = values
    return np.asarray(cv2.GaussianBlur(on_grid, (0, 0), sigma), np.float32)


def log_likelihood_ratio(
    image: NDArray[np.floating],
    area: NDArray[np.bool_],
    mixture: ColourMixture,
    alternative: ColourMixture,
    sigma: float,
    limit: float = np.inf,
) -> NDArray[np.float32]:
    """By how much (H, W) the colours of an area (H, W) are likelier of one mixture than of another: a logarithm.

    `image` (H, W, 3). No pixel counts for more than `limit`; the map is smoothed as `smoothed_map` does. Above 0 the first
    mixture is the likelier one.
    """
    colours = image[area]
    ratio = alternative.negative_log_likelihood(colours) - mixture.negative_log_likelihood(colours)
    return smoothed_map(np.clip(ratio, -limit, limit), area, sigma)


@dataclass(frozen=True)
class ContrastGraph:
    """The N pixels of an area, in reading order, and their 8-neighbours.

    edges : (E, 2), each pair once.
    weights : (E,), what it costs where the labels of two neighbours differ: little where their colours do, too.
    """

    edges: NDArray[np.intp]
    weights: NDArray[np.float64]

    @classmethod
    def of(cls, image: NDArray[np.floating], area: NDArray[np.bool_]) -> ContrastGraph:
        """The graph of the area (H, W) of a picture (H, W, 3): GrabCut's V, whose beta is half the inverse mean square
        of the neighbours' difference."""
        edges, lengths = grid_edges(area)
        pixels = image[area]
        difference = ((pixels[edges[:, 0]] - pixels[edges[:, 1]]) ** 2).sum(1)
        beta = 1 / (2 * max(float(difference.mean()), 1.0))
        return cls(edges, SMOOTHNESS_COST * np.exp(-beta * difference) / lengths)

    def cut(
        self, costs: NDArray[np.floating], labels: NDArray[np.integer], seeds: NDArray[np.integer] | None = None
    ) -> NDArray[np.intp]:
        """Labels (N,) that cost little, each by itself and where neighbours differ; of two labels the best there is.

        costs : (N, L) of each label at each pixel.
        labels : (N,) to begin with.
        seeds : (N,), the label that a pixel must have, `UNSEEDED_MARK` where it is sought. That of a pixel whose label is none of the L
            is L: it has no say.
        """
        if seeds is not None:
            another = seeds[:, None] != np.arange(costs.shape[1])
            costs = np.where(seeds[:, None] == UNSEEDED_MARK, costs, SEED_COST * another)
        return alpha_expansion(costs, self.edges, self.weights, labels)


def grab_cut(
    rgb: NDArray[np.uint8],
    foreground: NDArray[np.bool_],
    background: NDArray[np.bool_],
    probable: NDArray[np.bool_],
    rounds: int,
) -> NDArray[np.bool_]:
    """The foreground (H, W) of a picture (H, W, 3) by GrabCut, from seeds.

    foreground, background : (H, W), what surely is; they do not overlap.
    probable : (H, W), where foreground is taken to be at first, among what is neither.
    rounds : how often mixtures and cut are found anew from one another.

    Where all or nothing may be foreground at first, there are no colours to learn, and that is the answer.
    """
    labels = np.where(probable, cv2.GC_PR_FGD, cv2.GC_PR_BGD).astype(np.uint8)
    labels[background] = cv2.GC_BGD
    labels[foreground] = cv2.GC_FGD
    first = (labels == cv2.GC_FGD) | (labels == cv2.GC_PR_FGD)
    if first.all() or not first.any():
        return first
    cv2.setRNGSeed(1)
    models = np.zeros((1, 65)), np.zeros((1, 65))
    cv2.grabCut(np.ascontiguousarray(rgb), labels, (0, 0, 0, 0), *models, rounds, cv2.GC_INIT_WITH_MASK)
    return np.asarray((labels == cv2.GC_FGD) | (labels == cv2.GC_PR_FGD))
