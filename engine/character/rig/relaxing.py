"""What moves a surface goes over more slowly where the surface would stretch: below raised arms, at the hem of a skirt.

Beyond the paper, which carries the template's skinning weights over. They are a naked body's: an armpit of two centimetres
tears a wide sleeve's, which hangs twenty below it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import splu

from engine.character.rig.measures import pose
from engine.character.rig.rigging import Character, at_rest
from engine.character.surface.front_and_back import strongest
from engine.compiled import njit
from engine.geometry.mesh.welding import weld
from engine.geometry.rigging.skinning import skin
from engine.motion.kinematics import pose_transforms
from engine.motion.library import CLIPS, built_in

MIN_STRETCH_RATIO, FULL_STRETCH_RATIO = 2.5, 3.1
"""How many times as long as pictured an edge becomes that is made stiffer, and one that is made so by the most."""
MAX_STIFFENING_FACTOR = 10.0
"""By how much at most an edge is made stiffer in a round: how much more the difference of its ends' weights counts than what
these were."""
RELAXATION_ROUNDS = 7
STIFFENING_RINGS, STIFFENING_DECAY_PER_RING = 4, 0.8
"""How far around an edge others are made stiffer, in edges, and what is left of it with each."""
CLIP_FRAME_STEP = 10
"""Every how many frames of the built-in clips a mesh is tried."""
MIN_EDGE_METRES = 1e-4
"""Metres: what is shorter counts as so long."""
POSED_CHUNK_FRAMES = 16
"""Frames that are posed together."""


@dataclass(frozen=True)
class SurfaceGraph:
    """The points of a surface: where they are `pictured` (N, 3), metres, its `edges` (E, 2) and their `lengths` (E,), and which
    points are `neighbours` (N, N), with ones."""

    pictured: NDArray[np.float64]
    edges: NDArray[np.intp]
    lengths: NDArray[np.float64]
    neighbours: sparse.csr_matrix


@dataclass(frozen=True)
class _Bound:
    """Points bound to joints: places at rest (N, 3), influences (N, 4)."""

    places: NDArray[np.float32]
    bones: NDArray[np.uint8]
    weights: NDArray[np.float32]


def relaxed(character: Character) -> Character:
    """The character with weights by which its edges stretch less in the built-in clips. As pictured it is what it was.

    In some rounds edges that stretch too far, and those around, are made stiffer: weights follow that are as near to the
    old ones as differences along stiff edges permit. The round in whose worst frame the fewest edges are more than
    `FULL_STRETCH_RATIO` times as long as pictured is kept.
    """
    mesh = character.mesh
    point = weld(mesh)
    first = np.unique(point, return_index=True)[1]
    surface = _surface(pose(character, character.pictured)[first].astype(np.float64), point[mesh.triangles])
    pictured = pose_transforms(mesh.skeleton, character.pictured.rotations, character.pictured.root)[0]
    clips = [built_in(name, mesh.skeleton) for name in CLIPS]
    frames = np.concatenate(
        [
            pose_transforms(mesh.skeleton, clip.rotations[::CLIP_FRAME_STEP], clip.root[::CLIP_FRAME_STEP])
            for clip in clips
        ]
    )
    bound = best = _Bound(mesh.vertices[first], mesh.bones[first], mesh.weights[first])
    before = _dense(bound, len(mesh.skeleton.names))
    stretch, least = _stretch(surface, bound, frames)
    stiffness = np.zeros(len(first))
    for _ in range(RELAXATION_ROUNDS):
        stiffness += MAX_STIFFENING_FACTOR * _spread(
            surface, np.clip((stretch - MIN_STRETCH_RATIO) / (FULL_STRETCH_RATIO - MIN_STRETCH_RATIO), 0, 1)
        )
        weights = stiffened_weights(surface, before, stiffness)
        bound = _bound_anew(surface, bound, weights, (weights != before).any(1), pictured)
        stretch, share = _stretch(surface, bound, frames)
        if share < least:
            best, least = bound, share
    lift = np.array([0, -best.places[:, 1].min(), 0], np.float32)  # it stands on the ground as before
    skeleton = replace(mesh.skeleton, heads=mesh.skeleton.heads + lift)
    places = (best.places + lift)[point]
    anew = replace(mesh, skeleton=skeleton, vertices=places, bones=best.bones[point], weights=best.weights[point])
    return replace(character, mesh=anew)


def _surface(pictured: NDArray[np.float64], faces: NDArray[np.integer]) -> SurfaceGraph:
    ends = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), 1)
    count = len(pictured)
    name = np.unique(ends[:, 0].astype(np.int64) * count + ends[:, 1])
    edges = np.stack([name // count, name % count], 1).astype(np.intp)
    lengths = np.linalg.norm(pictured[edges[:, 0]] - pictured[edges[:, 1]], axis=1)
    half = sparse.csr_matrix((np.ones(len(edges)), edges.T), (count, count))
    return SurfaceGraph(pictured, edges, np.maximum(lengths, MIN_EDGE_METRES), half + half.T)


def _dense(bound: _Bound, joints: int) -> NDArray[np.float64]:
    """Weights (N, J) of all joints."""
    weights = np.zeros((len(bound.bones), joints))
    np.add.at(weights, (np.arange(len(weights))[:, None], bound.bones), bound.weights)
    return weights


def _stretch(surface: SurfaceGraph, bound: _Bound, frames: NDArray[np.float32]) -> tuple[NDArray[np.float64], float]:
    """How many times as long as pictured each edge (E,) becomes in frames (F, J, 4, 4), and the share of edges beyond
    `FULL_STRETCH_RATIO` in the worst of them."""
    most, worst = np.zeros(len(surface.edges)), 0
    for start in range(0, len(frames), POSED_CHUNK_FRAMES):
        posed = skin(bound.places, bound.bones, bound.weights, frames[start : start + POSED_CHUNK_FRAMES])
        worst = max(worst, _longest(posed, surface.edges, surface.lengths, most))
    return most, worst / max(len(most), 1)


@njit(nogil=True, boundscheck=False)
def _longest(posed: np.ndarray, edges: np.ndarray, lengths: np.ndarray, most: np.ndarray) -> int:
    worst = 0
    for f in range(len(posed)):
        far = 0
        for e in range(len(edges)):
            a, b = edges[e]
            square = 0.0
            for k in range(3):
                square += (posed[f, a, k] - posed[f, b, k]) ** 2
            times = np.sqrt(square) / lengths[e]
            most[e] = max(most[e], times)
            far += times > FULL_STRETCH_RATIO
        worst = max(worst, far)
    return worst


def _spread(surface: SurfaceGraph, wanted: NDArray[np.float64]) -> NDArray[np.float64]:
    """What edges (E,) want, for points (N,) at them and around."""
    spread = np.zeros(len(surface.pictured))
    for end in surface.edges.T:
        np.maximum.at(spread, end, wanted)
    degree = np.maximum(np.asarray(surface.neighbours.sum(1)).ravel(), 1)
    for _ in range(STIFFENING_RINGS):
        spread = np.maximum(spread, STIFFENING_DECAY_PER_RING * (surface.neighbours @ spread) / degree)
    return spread


def stiffened_weights(
    surface: SurfaceGraph, before: NDArray[np.float64], stiffness: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Weights w (N, J) with the least sum of |w_v - before_v|^2 over points and s_ab |w_a - w_b|^2 over edges, whose
    stiffness s is that of the stiffer end."""
    a, b = surface.edges.T
    stiff = np.maximum(stiffness[a], stiffness[b])
    half = sparse.csr_matrix((stiff, (a, b)), surface.neighbours.shape)
    both = half + half.T
    moved = np.flatnonzero(np.asarray(both.sum(1)).ravel() > 0)
    if not len(moved):
        return before
    inner = both[moved][:, moved]
    system = sparse.eye(len(moved)) + sparse.diags(np.asarray(inner.sum(1)).ravel()) - inner
    joints = np.flatnonzero(before[moved].any(0))
    weights = before.copy()
    solver = splu(system.tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    weights[np.ix_(moved, joints)] = solver.solve(np.ascontiguousarray(before[np.ix_(moved, joints)]))
    return weights


def _bound_anew(
    surface: SurfaceGraph,
    bound: _Bound,
    weights: NDArray[np.float64],
    moved: NDArray[np.bool_],
    pictured: NDArray[np.float32],
) -> _Bound:
    """Points that moved (N,) bound by weights (N, J), so that the joints as `pictured` (J, 4, 4) bring them to where they are."""
    places, all_bones, all_weights = bound.places.copy(), bound.bones.copy(), bound.weights.copy()
    bones, kept = strongest(weights[moved].astype(np.float32))
    back, kept, _ = at_rest(surface.pictured[moved], bones.astype(np.intp), kept, pictured)
    places[moved], all_bones[moved], all_weights[moved] = back, bones, kept
    return _Bound(places, all_bones, all_weights)
