"""Tracks: features of many pictures that are one point of space, out of matches of two pictures at a time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit


@dataclass(frozen=True)
class PairMatches:
    """What two pictures have in common: `matches` (M, 2), a feature of picture `first` and one of picture `second`."""

    first: int
    second: int
    matches: NDArray[np.intp]


@dataclass(frozen=True)
class Tracks:
    """Features by track, sorted by it: `track` (O,), `image` (O,), `feature` (O,), and how many tracks there are."""

    track: NDArray[np.intp]
    image: NDArray[np.intp]
    feature: NDArray[np.intp]
    count: int


def join_tracks(pairs: Sequence[PairMatches], features: Sequence[int]) -> Tracks:
    """The tracks of two pictures or more that matches connect, by union-find.

    A match that would give a track two features of one picture is wrong, or one before it was: it is left out. So the
    pairs that are most to be trusted come first.

    Parameters
    ----------
    features : how many each picture has.
    """
    begins = np.concatenate([[0], np.cumsum(features)]).astype(np.intp)
    edges = np.concatenate(
        [np.zeros((0, 2), np.intp), *(pair.matches + begins[[pair.first, pair.second]] for pair in pairs)]
    )
    image = np.repeat(np.arange(len(features)), np.diff(begins))
    label = np.arange(int(begins[-1]))
    pictures = np.zeros(
        (len(label), len(features) // 64 + 1), np.uint64
    )  # of a root: bits of the pictures of its track
    pictures[label, image // 64] = np.left_shift(np.uint64(1), (image % 64).astype(np.uint64))
    _unite(edges, label, pictures)
    often = np.bincount(label, minlength=len(label))[label] >= 2
    node = np.flatnonzero(often)
    node = node[np.argsort(label[node], kind="stable")]
    names, track = np.unique(label[node], return_inverse=True)
    return Tracks(track.astype(np.intp), image[node], node - begins[image[node]], len(names))


@njit(nogil=True)
def _unite(edges: np.ndarray, parent: np.ndarray, pictures: np.ndarray) -> None:
    """Afterwards each node's parent is its track's root."""
    for e in range(len(edges)):
        a, b = _root(parent, edges[e, 0]), _root(parent, edges[e, 1])
        if a == b:
            continue
        clash = False
        for k in range(pictures.shape[1]):
            clash |= (pictures[a, k] & pictures[b, k]) != 0
        if clash:
            continue
        parent[b] = a
        for k in range(pictures.shape[1]):
            pictures[a, k] |= pictures[b, k]
    for node in range(len(parent)):
        parent[node] = _root(parent, node)


@njit(nogil=True)
def _root(parent: np.ndarray, node: int) -> int:
    while parent[node] != node:
        parent[node] = parent[parent[node]]
        node = parent[node]
    return node
