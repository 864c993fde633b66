"""Skeletons that fit the template: joints that follow the shape, and skinning weights."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

RIG_NAMES = ("default", "mixamo", "game_engine")
"""`default` has 163 bones (fingers, toes, face), `mixamo` 52, `game_engine` those of common game engines."""

MIN_SKIN_WEIGHT = 1e-6
"""Weights below which a bone does not move a vertex."""

HUMAN_RIG = "human"
"""The rig that the project's people are made with: Mixamo's, then the joints of `FACE_JOINTS`."""
FACE_JOINTS = {"Jaw": "jaw", "LeftEye": "eye.L", "RightEye": "eye.R"}
"""Joints of the head that Mixamo's rig lacks, and the bones of `default` that they are."""
TOE_JOINTS = tuple(
    (f"{side}Foot", f"{side}ToeBase", f"foot.{side[0]}", tuple(f"toe{toe}-1.{side[0]}" for toe in range(1, 6)))
    for side in ("Left", "Right")
)
"""Foot and toes in Mixamo's rig, and the bones of `default` that they are: the foot's, and each toe's."""


@dataclass(frozen=True)
class Rig:
    """Bones, parents before children, and the weights by which they move the template's vertices.

    names : of the B bones.
    parents : (B,) int32, -1 for the root.
    starts : (2B + 1,) int32, where the spans of `anchors` begin: those of bone b's head and tail are 2b and 2b + 1.
    anchors : (A,) int32, vertices. A head or tail is the mean of its span, so that a skeleton fits any shape of the template.
    rolls : (B,) float32 radians, as MakeHuman gives them.
    bones : (V, K) uint8, the bones that move each vertex, strongest first; the root where no bone does.
    weights : (V, K) float32, how much each of them does, summing to one.
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

    def weights_below(self, name: str) -> NDArray[np.float64]:
        """What a bone and all that hang on it weigh at each vertex together, (V,) in [0, 1]."""
        below = np.zeros(len(self.names), np.bool_)
        below[self.index(name)] = True
        for bone, parent in enumerate(self.parents):
            below[bone] |= parent >= 0 and below[parent]
        return np.asarray((self.weights.astype(np.float64) * below[self.bones]).sum(1))


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


def with_face(body: Rig, face: Rig) -> Rig:
    """`body` (Mixamo's rig) and, after its own, the joints of `FACE_JOINTS`, children of `Head`, from `face` (`default`).

    Jaw and eyes take of the weight that the head has at a vertex what they have of it in `face`; lower lip and tongue,
    whose bones hang on the jaw there, go with the jaw.
    """
    carried = face.weights_below("head")
    head = body.weights_below("Head")
    own = np.stack([face.weights_below(bone) for bone in FACE_JOINTS.values()], 1)
    moved = head[:, None] * own / np.maximum(carried, 1e-9)[:, None]
    table = np.zeros((len(head), len(body.names) + len(FACE_JOINTS)))
    for rank in range(body.bones.shape[1]):
        table[np.arange(len(head)), body.bones[:, rank]] += body.weights[:, rank]
    table[:, body.index("Head")] -= moved.sum(1)
    table[:, len(body.names) :] = moved
    order = np.argsort(-table, axis=1, kind="stable")[:, : int((table > MIN_SKIN_WEIGHT).sum(1).max())]
    weights = np.take_along_axis(table, order, 1)
    weights = np.where(weights > MIN_SKIN_WEIGHT, weights, 0)
    at = [face.index(bone) for bone in FACE_JOINTS.values()]
    spans = [face.anchors[face.starts[2 * b + end] : face.starts[2 * b + end + 1]] for b in at for end in (0, 1)]
    return Rig(
        names=(*body.names, *FACE_JOINTS),
        parents=np.append(body.parents, [body.index("Head")] * len(FACE_JOINTS)).astype(np.int32),
        starts=np.append(body.starts, body.starts[-1] + np.cumsum([len(span) for span in spans])).astype(np.int32),
        anchors=np.concatenate([body.anchors, *spans]),
        rolls=np.append(body.rolls, face.rolls[at]),
        bones=np.where(weights > 0, order, 0).astype(np.uint8),
        weights=(weights / weights.sum(1, keepdims=True)).astype(np.float32),
    )


def with_toes(body: Rig, toed: Rig) -> Rig:
    """`body` (Mixamo's rig), in which toes have of each foot what its toes have of it in `toed` (`default`).

    In the source foot and toes move half each of what lies before the ball, up to the tips, which are the toes' alone.
    """
    weights = body.weights.astype(np.float64)
    for foot, toes, whole, parts in TOE_JOINTS:
        share = sum(toed.weights_below(part) for part in parts) / np.maximum(toed.weights_below(whole), 1e-9)
        own = [body.bones == body.index(name) for name in (foot, toes)]
        both = (weights * (own[0] | own[1])).sum(1)
        for which, part in zip(own, (1 - share, share), strict=True):
            weights = np.where(which, (both * np.clip(part, 0, 1))[:, None], weights)
    order = np.argsort(-weights, axis=1, kind="stable")
    weights = np.take_along_axis(weights, order, 1)
    weights /= weights.sum(1, keepdims=True)
    return replace(body, bones=np.take_along_axis(body.bones, order, 1), weights=weights.astype(np.float32))


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
