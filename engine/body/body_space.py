"""A statistical space of bodies in T-pose: the mean, and the directions in which people differ most.

Principal components of bodies sampled over MakeHuman's phenotypes (`engine.body.shape`), each with some local changes to
limbs and torso, all brought to one rest pose. Joints are part of what is analysed, so that a skeleton follows from the
same coefficients (a linear joint regression).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from engine.body.cache import cached_arrays
from engine.body.rest_pose import t_pose
from engine.body.rig import HUMAN_RIG, Rig
from engine.body.shape import Phenotype, ShapeSpace, load_shape_space
from engine.body.template import load_rig, load_template
from engine.geometry.rigging.skeleton import Skeleton

SPACE_COMPONENTS = 40
SAMPLED_BODY_COUNT = 600
SAMPLING_SEED = 20

VARIED_REGIONS = ("arms", "legs", "torso", "hip", "stomach", "pelvis", "buttocks", "neck", "feet", "hands")
"""The parts of the body of which some are changed in each sample."""
CHANGES_PER_SAMPLE = 6
"""Local changes of a sample."""
MAX_LOCAL_CHANGE = 0.7
"""Strength of a local change, at most, in [0, 1] of MakeHuman's own range."""


@dataclass(frozen=True)
class BodySpace:
    """Bodies as `mean` + `coefficients` in units of standard deviations.

    mean : (V, 3) float32 metres, the template's vertices in T-pose, feet on the ground, facing +z.
    basis : (K, V, 3) float32 metres, what one unit of each coefficient adds to them.
    names : of the J joints.
    parents : (J,) int32, the parent of each joint, -1 for the root.
    joint_mean : (J, 3) float32 metres, the joints of the mean body.
    joint_basis : (K, J, 3) float32 metres, what one unit of each coefficient adds to them.
    variance_held : (K,) float32, the share of the samples' variance that the first 1, 2, ... K components hold.
    """

    mean: NDArray[np.float32]
    basis: NDArray[np.float32]
    names: tuple[str, ...]
    parents: NDArray[np.int32]
    joint_mean: NDArray[np.float32]
    joint_basis: NDArray[np.float32]
    variance_held: NDArray[np.float32]

    def vertices(self, coefficients: NDArray[np.floating]) -> NDArray[np.float32]:
        """The template's vertices (V, 3) in T-pose for up to K coefficients."""
        count = len(coefficients)
        return self.mean + np.tensordot(np.asarray(coefficients, np.float32), self.basis[:count], 1)

    def joints(self, coefficients: NDArray[np.floating]) -> NDArray[np.float32]:
        """The joints (..., J, 3) for coefficients (..., up to K)."""
        basis = self.joint_basis[: np.shape(coefficients)[-1]]
        return self.joint_mean + np.tensordot(np.asarray(coefficients, np.float32), basis, 1)

    def skeleton(self, coefficients: NDArray[np.floating]) -> Skeleton:
        """The skeleton for up to K coefficients."""
        return Skeleton(self.names, self.parents, self.joints(coefficients))

    def with_joints_of(self, rig: Rig) -> BodySpace:
        """These bodies with the joints of another rig alone, all of which this one has."""
        at = [self.names.index(name) for name in rig.names]
        return replace(
            self,
            names=rig.names,
            parents=rig.parents,
            joint_mean=self.joint_mean[at],
            joint_basis=self.joint_basis[:, at],
        )


@cache
def load_body_space() -> BodySpace:
    """Load the space; the first time, sample and analyse it (about a minute)."""
    stored = cached_arrays("bodies", _convert)
    scale = stored["scale"]
    return BodySpace(
        mean=stored["mean"],
        basis=stored["counts"] * scale[:, None, None],
        names=tuple(str(name) for name in stored["names"]),
        parents=stored["parents"],
        joint_mean=stored["joint_mean"],
        joint_basis=stored["joint_basis"],
        variance_held=stored["variance_held"],
    )


def sample_bodies(count: int, seed: int) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Random bodies in T-pose: vertices (count, V, 3) and joints (count, J, 3) float32 metres."""
    random = np.random.default_rng(seed)
    space, rig = load_shape_space(), load_rig(HUMAN_RIG)
    standing = load_template().vertices_of("body")
    bodies, joints = [], []
    for _ in range(count):
        skeleton, _, vertices = t_pose(rig, space.shape(random_phenotype(random), _changes(space, random)), standing)
        bodies.append(vertices)
        joints.append(skeleton.heads)
    return np.stack(bodies), np.stack(joints)


def random_phenotype(random: np.random.Generator) -> Phenotype:
    """Somebody: adults mostly, some children; most of average build."""
    child = random.random() < 0.15
    age = random.uniform(0.19, 0.4) if child else random.uniform(0.4, 0.95)
    build = np.clip(random.normal(0.5, 0.22, 4), 0, 1)
    return Phenotype(age, random.uniform(), *(float(axis) for axis in build), *random.dirichlet(np.ones(3)))


def _changes(space: ShapeSpace, random: np.random.Generator) -> dict[str, float]:
    """Some changes to limbs and torso, the same on both sides."""
    offered = [name for room in VARIED_REGIONS for name in space.rooms[room] if not name.startswith("r-")]
    chosen = random.choice(offered, CHANGES_PER_SAMPLE, replace=False)
    changes = {str(name): float(random.uniform(0, MAX_LOCAL_CHANGE)) for name in chosen}
    return changes | {f"r-{name[2:]}": weight for name, weight in changes.items() if name.startswith("l-")}


def _convert() -> dict[str, np.ndarray]:
    bodies, joints = sample_bodies(SAMPLED_BODY_COUNT, SAMPLING_SEED)
    rows = np.concatenate([bodies, joints], 1).reshape(SAMPLED_BODY_COUNT, -1).astype(np.float64)
    mean = rows.mean(0)
    rows -= mean
    values, vectors = np.linalg.eigh(rows @ rows.T)
    order = np.argsort(values)[::-1][:SPACE_COMPONENTS]
    directions = vectors[:, order].T @ rows / np.sqrt(SAMPLED_BODY_COUNT)  # one standard deviation each
    basis = directions.reshape(SPACE_COMPONENTS, -1, 3)
    split = bodies.shape[1]
    scale = np.abs(basis[:, :split]).max((1, 2)) / np.iinfo(np.int16).max
    rig = load_rig(HUMAN_RIG)
    return {
        "mean": mean.reshape(-1, 3)[:split].astype(np.float32),
        "joint_mean": mean.reshape(-1, 3)[split:].astype(np.float32),
        "joint_basis": basis[:, split:].astype(np.float32),
        "counts": np.round(basis[:, :split] / scale[:, None, None]).astype(np.int16),
        "scale": scale.astype(np.float32),
        "names": np.array(rig.names),
        "parents": rig.parents,
        "variance_held": (np.cumsum(values[order]) / values.sum()).astype(np.float32),
    }
