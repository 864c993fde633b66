"""Skeletons that fit the template: joints that follow the shape, and skinning weights."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

RIGS = ("default", "mixamo", "game_engine")
"""`default` has 163 bones (fingers, toes, face), `mixamo` 52, `game_engine` those of common game engines."""


@dataclass(frozen=True)
class Rig:
    """Bones, parents before children, and the weights by which they move the template's vertices.

    `parents` (B,) int32, -1 for the root. `starts` (2B + 1,) int32 and `anchors`: the head of bone `b` is the
    mean of the vertices `anchors[starts[2b]:starts[2b + 1]]`, its tail that of the next span, so that a skeleton
    fits whatever shape the template is given. `rolls` (B,) float32 radians, as MakeHuman gives them.
    `bones` (V, K) uint8 and `weights` (V, K) float32: each vertex' influences, strongest first, summing to one;
    vertices that no bone moves belong to the root.
    """

    names: tuple[str, ...]
    parents: NDArray[np.int32]
    starts: NDArray[np.int32]
    anchors: NDArray[np.int32]
    rolls: NDArray[np.float32]
    bones: NDArray[np.uint8]
    weights: NDArray[np.float32]

    def index(self, name: str) -> int:
        """The bone's index; ValueError if the rig has no such bone."""
        return self.names.index(name)

    def joints(self, vertices: NDArray[np.floating]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """Heads and tails of the bones, (B, 3) float32 each, for the template in the shape `vertices` (V, 3)."""
        sums = np.add.reduceat(np.asarray(vertices, np.float64)[self.anchors], self.starts[:-1])
        ends = (sums / np.diff(self.starts)[:, None]).astype(np.float32)
        return ends[0::2], ends[1::2]


def build_rig(
    bones: Mapping[str, Any],
    weights: Mapping[str, list[list[float]]],
    groups: Mapping[str, list[list[int]]],
    vertex_count: int,
) -> Rig:
    """A `Rig` from MPFB2's description of it (`engine.body.makehuman.read_rig`, `read_vertex_groups`).

    The weights of some vertices do not sum to one in the source: they are normalised.
    """
    names = _parents_first({name: bone["parent"] for name, bone in bones.items()})
    spans = [_anchors(bones[name][end], groups) for name in names for end in ("head", "tail")]
    influences: list[list[tuple[float, int]]] = [[] for _ in range(vertex_count)]
    for index, name in enumerate(names):
        for vertex, weight in weights.get(name, []):
            if weight > 0:
                influences[int(vertex)].append((weight, index))
    width = max(len(row) for row in influences)
    by_bone = np.zeros((vertex_count, width), np.uint8)
    by_weight = np.zeros((vertex_count, width), np.float32)
    by_weight[:, 0] = 1
    for vertex, row in enumerate(influences):
        total = sum(weight for weight, _ in row)
        for rank, (weight, index) in enumerate(sorted(row, reverse=True)):
            by_bone[vertex, rank], by_weight[vertex, rank] = index, weight / total
    return Rig(
        names=tuple(name.removeprefix("mixamorig:") for name in names),
        parents=np.array([names.index(p) if (p := bones[name]["parent"]) else -1 for name in names], np.int32),
        starts=np.cumsum([0, *(len(span) for span in spans)], dtype=np.int32),
        anchors=np.concatenate(spans).astype(np.int32),
        rolls=np.array([bones[name]["roll"] for name in names], np.float32),
        bones=by_bone,
        weights=by_weight,
    )


def _parents_first(parents: Mapping[str, str]) -> list[str]:
    ordered: list[str] = []
    waiting = list(parents)
    while waiting:
        ready = [name for name in waiting if not parents[name] or parents[name] in ordered]
        ordered += ready
        waiting = [name for name in waiting if name not in ready]
    return ordered


def _anchors(end: Mapping[str, Any], groups: Mapping[str, list[list[int]]]) -> list[int]:
    """The vertices whose mean is one end of a bone."""
    match end["strategy"]:
        case "CUBE":
            return [v for first, last in groups[end["cube_name"]] for v in range(first, last + 1)]
        case "VERTEX":
            return [end["vertex_index"]]
        case _:
            return list(end["vertex_indices"])
