"""The toes as a disk without folds, from which the cap of a shoe is made."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

from engine.geometry.mesh.adjacency import edges
from engine.geometry.texture_charts.injective_disk import injective_disk

TOE_SHARE = 0.66
"""Of a foot's length from the heel, from where on it is toes."""
EVENING_ROUNDS, EVENING_EXPONENT = 10, 0.4
"""How often long edges are given more weight, and how much more: between toes few vertices have to span much of a shoe."""


@dataclass(frozen=True)
class ToeCap:
    """The toes of one foot on the unit disk.

    rim : (L,) int, vertices around them, in order.
    inside : (M,) int, the toes' own.
    disk : (M, 2) where they are in the disk, on whose edge the rim is, by the length along it, from (1, 0) on.
    """

    rim: NDArray[np.intp]
    inside: NDArray[np.intp]
    disk: NDArray[np.float64]


def toe_cap(vertices: NDArray[np.floating], triangles: NDArray[np.integer], foot: NDArray[np.bool_]) -> ToeCap:
    """The cap of one foot of a body at rest, `vertices` (S, 3) and `triangles` (T, 3), facing +z; `foot` (S,): which are its."""
    places = np.asarray(vertices, np.float64)
    along = places[:, 2]
    heel, tip = along[foot].min(), along[foot].max()
    toes = foot & (along > heel + TOE_SHARE * (tip - heel))
    faces = _largest_piece(np.asarray(triangles)[toes[triangles].all(1)], len(places))
    rim = _outer_loop(faces)
    inside = np.setdiff1d(faces, rim)
    lengths = np.linalg.norm(np.roll(places[rim], -1, 0) - places[rim], axis=1)
    turns = 2 * np.pi * np.concatenate([[0], np.cumsum(lengths)[:-1]]) / lengths.sum()
    edge = np.stack([np.cos(turns), np.sin(turns)], 1)
    number = np.full(len(places), -1)
    number[np.concatenate([inside, rim])] = np.arange(len(inside) + len(rim))
    return ToeCap(rim, inside, _evened(injective_disk(number[faces], edge, len(inside)), edge, number[faces]))


def _evened(disk: NDArray[np.float64], edge: NDArray[np.float64], faces: NDArray[np.intp]) -> NDArray[np.float64]:
    """(M, 2) places in the disk, of a hemisphere's edges of more even length: W. T. Tutte's map, which has no folds, with weights
    that grow where edges are long."""
    free, places = len(disk), np.concatenate([disk, edge])
    pairs = edges(faces)
    weights = np.ones(len(pairs))
    for _ in range(EVENING_ROUNDS):
        radius = np.linalg.norm(places, axis=1, keepdims=True)
        bent = np.minimum(radius, 1) * np.pi / 2
        dome = np.concatenate([places / np.maximum(radius, 1e-9) * np.sin(bent), np.cos(bent)], 1)
        lengths = np.linalg.norm(dome[pairs[:, 0]] - dome[pairs[:, 1]], axis=1)
        weights *= (lengths / lengths.mean()) ** EVENING_EXPONENT
        weights = np.clip(weights / weights.mean(), 1e-3, 1e3)
        ends = (pairs.ravel(), pairs[:, ::-1].ravel())
        beside = sp.csr_array((weights.repeat(2), ends), (len(places), len(places)))
        laplacian = sp.csr_array(sp.diags_array(beside.sum(1)) - beside)[:free]
        pulled = np.asarray(laplacian[:, free:] @ edge)
        places[:free] = splu(sp.csc_array(laplacian[:, :free])).solve(-pulled)
    return places[:free]


def _largest_piece(faces: NDArray[np.integer], count: int) -> NDArray[np.intp]:
    ends = (faces.ravel(), np.roll(faces, -1, 1).ravel())
    graph = sp.csr_array((np.ones(faces.size), ends), (count, count))
    _, piece = connected_components(graph, directed=False)
    return np.asarray(faces[piece[faces[:, 0]] == np.bincount(piece[faces[:, 0]]).argmax()], np.intp)


def _outer_loop(faces: NDArray[np.intp]) -> NDArray[np.intp]:
    """The longest border of a piece of a surface, in the order of its triangles' edges."""
    half = {(int(a), int(b)) for face in faces for a, b in zip(face, np.roll(face, -1), strict=True)}
    following = {a: b for a, b in half if (b, a) not in half}
    loops: list[list[int]] = []
    while following:
        loop = [next(iter(following))]
        while (after := following.pop(loop[-1], None)) is not None and after != loop[0]:
            loop.append(after)
        loops.append(loop)
    return np.array(max(loops, key=len), np.intp)
