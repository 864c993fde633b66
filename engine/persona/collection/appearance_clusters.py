"""The looks of a person in a collection: photographs that are more like one another than like the others, of a decade say."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.vq import kmeans2
from scipy.spatial.distance import pdist

MAX_LOOKS = 4
MIN_PHOTOS_OF_LOOK = 20
"""Of fewer no persona can be made once some are of no use."""
MIN_DISTANCE = 0.42
"""Between the means of two looks, in shares of the distance below which faces are one person's: smiles and light are less apart."""
KMEANS_SEEDS = 8
"""Beginnings of k-means, of which the one is taken that leaves least."""


def appearance_clusters(descriptors: Sequence[NDArray[np.floating]], same: float) -> tuple[int, ...]:
    """For each of N descriptors of one person's faces which look it is of, numbered by how many have it, the most
    first. There are as many looks, four at most, as k-means finds apart with `MIN_PHOTOS_OF_LOOK` photographs each;
    else all are of one. `same` is the distance of descriptors below which faces are one person's."""
    rows = np.asarray(descriptors, np.float64)
    for count in range(min(MAX_LOOKS, len(rows) // MIN_PHOTOS_OF_LOOK), 1, -1):
        labels = min(
            (_k_means(rows, count, seed) for seed in range(KMEANS_SEEDS)), key=lambda found: _left(rows, found)
        )
        sizes = np.bincount(labels, minlength=count)
        if sizes.min() >= MIN_PHOTOS_OF_LOOK and _least_apart(rows, labels) >= MIN_DISTANCE * same:
            place = np.argsort(np.argsort(-sizes, kind="stable"))
            return tuple(int(place[label]) for label in labels)
    return (0,) * len(rows)


def _k_means(rows: NDArray[np.float64], count: int, seed: int) -> NDArray[np.intp]:
    return np.asarray(kmeans2(rows, count, iter=50, minit="++", seed=seed)[1], np.intp)


def _left(rows: NDArray[np.float64], labels: NDArray[np.intp]) -> float:
    """The sum of squares about the means of what has one label."""
    return float(sum(((rows[labels == k] - rows[labels == k].mean(axis=0)) ** 2).sum() for k in np.unique(labels)))


def _least_apart(rows: NDArray[np.float64], labels: NDArray[np.intp]) -> float:
    """The least distance between the means of two labels."""
    return float(pdist(np.array([rows[labels == k].mean(axis=0) for k in np.unique(labels)])).min())
