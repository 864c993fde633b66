"""A head that no face holds, as under a helmet: placed and sized by the person's outlines in all frames.

Five numbers, its place, how it is bent ahead and its size, cannot follow masks' faults into a shape that is nobody's head.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.avatar.registration.hand_pose import CoarseBody
from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.part_outlines import OutlinePoints, PartSight, Silhouette, outline_points, part_sights
from engine.avatar.registration.template_skin.skin import grown
from engine.body.fitting.least_squares import levenberg_marquardt
from engine.geometry.deformation.handles import handles
from engine.geometry.deformation.laplacian_deformation import LaplacianDeformation

HEAD_JOINT_NAMES = ("Head", "Jaw", "LeftEye", "RightEye")
"""The joints that go with a head as a whole; the first turns all of it."""
LOWERED_NECK_RINGS = 6
"""Rings of vertices about the neck, of shoulders, nape and throat, that go over from the body to the head. A head that
stands lower has no room for a neck alone, which would be folded."""
HEAD_PLACE_SIGMA_METRES = 0.05
"""Metres by which a head is off where the coarse fit has it, usually, along each axis."""
HEAD_BEND_SIGMA_RADIANS = 0.15
"""Radians by which a head is bent otherwise than the coarse fit has it, usually."""
HEAD_SIZE_SIGMA = 0.1
"""Logarithm of the size by which a head with what covers it is larger than is usual for the body."""
HEAD_GATES_METRES = (0.15, 0.15, 0.12, 0.1, 0.08, 0.06, 0.05, 0.04, 0.03, 0.03)
"""Metres within which outlines are matched, from round to round."""
HEAD_OUTLINE_SIGMA_METRES = 0.004
"""Metres by which outlines of a head are off, at least: a helmet has another shape."""
INDEPENDENT_HEAD_OUTLINE_POINTS = 40.0
"""As how many independent measurements all points of a head's outlines count."""


@dataclass(frozen=True)
class _Head:
    """The head as the coarse fit has it.

    numbers : (H,) of the skin's vertices.
    places : (H, 3) metres, theirs from its joint.
    triangles : (T, 3) of them.
    joint : (3,) metres, where that is.
    side : (3,) unit vector to its left, about which it bends.
    """

    numbers: NDArray[np.intp]
    places: NDArray[np.float64]
    triangles: NDArray[np.intp]
    joint: NDArray[np.float64]
    side: NDArray[np.float64]

    def moved(self, places: NDArray[np.float64], parameters: NDArray[np.float64]) -> NDArray[np.float64]:
        """(N, M, 3) where places (M, 3) from the joint are in the world, for parameters (N, 5): by how much the joint is shifted (x, y, z),
        how the head is bent ahead, and the logarithm of its relative size."""
        turned = Rotation.from_rotvec(parameters[:, 3:4] * self.side).as_matrix()
        sized = np.exp(parameters[:, 4])[:, None, None] * np.einsum("nab,mb->nma", turned, places)
        return np.asarray(sized + self.joint + parameters[:, None, :3])


def with_head_in_outlines(models: HumanModels, body: CoarseBody, silhouettes: Sequence[Silhouette]) -> CoarseBody:
    """The coarse fit `body` with its head where the person's `silhouettes` have it; its neck follows."""
    head = _head(models, body)
    skin = models.skin
    elsewhere = skin.triangles[~np.isin(skin.triangles, head.numbers).any(1)]
    sights = part_sights(silhouettes, head.places + head.joint, body.vertices, elsewhere)
    found = _laid(head, sights)
    names = np.array(models.rig.names)
    neck = grown(names[skin.bones[:, 0]] == "Neck", skin.triangles, LOWERED_NECK_RINGS) & ~skin.regions["face"]
    moved = body.vertices.copy()
    moved[head.numbers] = head.moved(head.places, found[None])[0]
    deformation = LaplacianDeformation(body.vertices, skin.triangles, handles(len(moved), np.flatnonzero(~neck)))
    own = np.isin(names, HEAD_JOINT_NAMES)
    joints, rotations = body.joints.copy(), body.rotations.copy()
    joints[own] = head.moved(joints[own] - head.joint, found[None])[0]
    rotations[own] = Rotation.from_rotvec(found[3] * head.side).as_matrix() @ rotations[own]
    share = (models.rig.weights * own[models.rig.bones]).sum(1)[:, None]
    whole = body.whole + share * (head.moved(body.whole - head.joint, found[None])[0] - body.whole)
    return replace(body, vertices=deformation(moved[~neck]), whole=whole, joints=joints, rotations=rotations)


def _head(models: HumanModels, body: CoarseBody) -> _Head:
    skin = models.skin
    turned = models.rig.index(HEAD_JOINT_NAMES[0])
    joint = body.joints[turned]
    of_head = skin.regions["head"]
    numbers = np.flatnonzero(of_head)
    triangles = np.searchsorted(numbers, skin.triangles[of_head[skin.triangles].all(1)])
    return _Head(numbers, body.vertices[numbers] - joint, triangles, joint, body.rotations[turned][:, 0])


def _laid(head: _Head, sights: Sequence[PartSight]) -> NDArray[np.float64]:
    """The parameters (5,) for which the head's outlines are nearest to those in the sights."""
    sigmas = np.array([HEAD_PLACE_SIGMA_METRES] * 3 + [HEAD_BEND_SIGMA_RADIANS, HEAD_SIZE_SIGMA])
    found = np.zeros(len(sigmas))
    for gate in HEAD_GATES_METRES:
        vertices = head.moved(head.places, found[None])[0]
        outlines = [outline_points(sight, vertices, head.triangles, head.places) for sight in sights]
        outlines = [outline for outline in outlines if len(outline.places)]
        if not outlines:
            return found
        now = _off(head, outlines, found[None])[0]
        weights = np.where(np.abs(now) < gate, (1 - (now / gate) ** 2) ** 2, 0.0)
        if not weights.any():
            return found
        sigma = max(float(np.sqrt((weights * now**2).sum() / weights.sum())), HEAD_OUTLINE_SIGMA_METRES)
        scale = np.sqrt(weights * min(1.0, INDEPENDENT_HEAD_OUTLINE_POINTS / weights.sum())) / sigma
        found = levenberg_marquardt(partial(_residuals, head, outlines, scale, sigmas), found, steps=5)
    return found


def _off(head: _Head, outlines: Sequence[OutlinePoints], parameters: NDArray[np.float64]) -> NDArray[np.float64]:
    """(N, M) metres by which all points of outlines are outside of the person's, for parameters (N, 5)."""
    return np.concatenate([outline.off(head.moved, parameters) for outline in outlines], axis=1)


def _residuals(
    head: _Head,
    outlines: Sequence[OutlinePoints],
    scale: NDArray[np.float64],
    sigmas: NDArray[np.float64],
    parameters: NDArray[np.float64],
) -> NDArray[np.float64]:
    return np.concatenate([parameters / sigmas, _off(head, outlines, parameters) * scale], axis=1)
