"""A statistical space of heads: the mean, and the directions in which people's heads differ most.

Principal components of heads sampled over MakeHuman's phenotypes and the local changes of `FACE_ROOMS`, all laid on one another
by similarities: what differs is shape alone, neither size nor place. The role of the head model of section 3.4 of S.
Wenninger et al., Realistic Virtual Humans from Smartphone Videos, VRST 2020.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from engine.body.body_space import load_body_space, random_phenotype
from engine.body.cache import cached_arrays
from engine.body.rig import HUMAN_RIG
from engine.body.shape import ShapeSpace, load_shape_space
from engine.body.template import load_rig, load_template
from engine.geometry.registration.rigid import fit_similarity

HEAD_COMPONENTS = 30
"""Directions in the space."""
SAMPLED_HEADS = 400
"""Heads that are analysed."""
HEAD_SEED = 30
"""Seed of the sampling of heads."""
FACE_ROOMS = ("nose", "chin", "cheek", "eyes", "forehead", "head", "mouth", "ears", "eyebrows", "neck")
"""The parts of the head of which some are changed in each sample."""
CHANGES_PER_HEAD = 14
"""Local changes of a sample."""
MAX_HEAD_CHANGE = 0.7
"""How strong local changes are at most, in [0, 1] of MakeHuman's own range."""


@dataclass(frozen=True)
class HeadSpace:
    """Heads as `mean` + `coefficients` in units of standard deviations.

    vertices : (H,) int, the template's vertices that are skin of the head.
    mean : (H, 3) float32 metres, where they are in T-pose.
    basis : (K, H, 3) float32 metres.
    variance_held : (K,) the share of the samples' variance in the first 1, 2, ... K directions.
    """

    vertices: NDArray[np.intp]
    mean: NDArray[np.float32]
    basis: NDArray[np.float32]
    variance_held: NDArray[np.float32]


@cache
def load_head_space() -> HeadSpace:
    """Load the space; the first time, sample and analyse it (some twenty seconds)."""
    stored = cached_arrays("heads", _convert)
    return HeadSpace(stored["vertices"].astype(np.intp), stored["mean"], stored["basis"], stored["variance_held"])


def sample_heads(count: int, seed: int, vertices: NDArray[np.integer]) -> NDArray[np.float64]:
    """(count, H, 3) random heads at the template's `vertices` (H,), each laid on the mean body's by a similarity, metres."""
    random = np.random.default_rng(seed)
    space, mean = load_shape_space(), load_body_space().mean[vertices].astype(np.float64)
    heads = np.empty((count, len(vertices), 3))
    for n in range(count):
        shaped = space.shape(random_phenotype(random), _changes(space, random))[vertices].astype(np.float64)
        heads[n] = fit_similarity(shaped, mean)(shaped)
    return heads


def _changes(space: ShapeSpace, random: np.random.Generator) -> dict[str, float]:
    """Some changes to the face, the same on both sides."""
    known = [name for room in FACE_ROOMS for name in space.rooms[room]]
    offered = [name for name in known if not name.startswith("r-")]
    chosen = random.choice(offered, CHANGES_PER_HEAD, replace=False)
    changes = {str(name): float(random.uniform(0, MAX_HEAD_CHANGE)) for name in chosen}
    mirrored = {f"r-{name[2:]}": weight for name, weight in changes.items() if name.startswith("l-")}
    return changes | {name: weight for name, weight in mirrored.items() if name in known}


def _convert() -> dict[str, np.ndarray]:
    rig, body = load_rig(HUMAN_RIG), load_template().vertices_of("body")
    strongest = np.array(rig.names)[rig.bones[body, 0]]
    vertices = body[np.isin(strongest, ["Head", "Jaw", "LeftEye", "RightEye"])]
    heads = sample_heads(SAMPLED_HEADS, HEAD_SEED, vertices).reshape(SAMPLED_HEADS, -1)
    mean = heads.mean(0)
    off = heads - mean
    values, vectors = np.linalg.eigh(off @ off.T)
    order = np.argsort(values)[::-1][:HEAD_COMPONENTS]
    directions = vectors[:, order].T @ off / np.sqrt(SAMPLED_HEADS)
    return {
        "vertices": vertices,
        "mean": mean.reshape(-1, 3).astype(np.float32),
        "basis": directions.reshape(HEAD_COMPONENTS, -1, 3).astype(np.float32),
        "variance_held": (np.cumsum(values[order]) / values.sum()).astype(np.float32),
    }
