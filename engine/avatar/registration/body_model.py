"""The body of the statistical space in a pose, and how its skin moves with every parameter."""

from __future__ import annotations

import numpy as np
from numba import prange
from numpy.typing import NDArray

from engine.avatar.registration.template_skin.skin import Skin
from engine.body.body_space import BodySpace
from engine.body.fitting.posing import BodyPoser
from engine.body.landmarks import LandmarkModel
from engine.compiled import njit
from engine.geometry.rigging.skinning import skin as blend

TURN_STEP = 1e-4
"""Step of a place or a turn by which the derivatives of the joints' transforms are taken."""
SHAPE_STEP = 0.5
"""Step of a body's coefficient, by which theirs are taken: transforms are linear in it, and of single precision."""


class BodyModel:
    """Skin by linear blend skinning from the parameters (P,) of `engine.body.fitting.posing.BodyPoser`: the root's translation,
    the rotation vectors of its joints, and K coefficients of the space."""

    def __init__(self, space: BodySpace, skin: Skin, coefficients: int):
        self.poser = BodyPoser(space)
        self.coefficients = coefficients
        self.skin = skin
        self._mean = space.mean[skin.vertices].astype(np.float64)
        self.soles = _soles(space, skin)
        self._basis = np.ascontiguousarray(space.basis[:coefficients, skin.vertices].transpose(1, 0, 2), np.float64)

    def transforms(self, parameters: NDArray[np.float64]) -> NDArray[np.float64]:
        """(N, J, 4, 4) what each joint does to the body at rest, for parameters (N, P)."""
        posed = self.poser(parameters)
        out = np.zeros((*posed.joints.shape[:2], 4, 4))
        out[..., :3, :3] = posed.world_rotations
        out[..., :3, 3] = posed.joints - np.einsum("njab,njb->nja", posed.world_rotations, posed.rest)
        out[..., 3, 3] = 1
        return out

    def rest(self, parameters: NDArray[np.float64]) -> NDArray[np.float64]:
        """(S, 3) the skin in T-pose, metres."""
        return self._mean + np.einsum("skc,k->sc", self._basis, parameters[-self.coefficients :])

    def vertices(self, parameters: NDArray[np.float64]) -> NDArray[np.float64]:
        """(S, 3) the skin in its pose, metres."""
        transforms = self.transforms(parameters[None])[0]
        return blend(self.rest(parameters), self.skin.bones, self.skin.weights, transforms).astype(np.float64)

    def derivatives(self, parameters: NDArray[np.float64], chosen: NDArray[np.integer]) -> NDArray[np.float64]:
        """(C, 3, P) how the `chosen` (C,) vertices of the skin move with each parameter."""
        count = len(parameters)
        now = self.transforms(parameters[None])[0]
        steps = np.full(count, TURN_STEP)
        steps[-self.coefficients :] = SHAPE_STEP
        ahead = self.transforms(parameters + np.diag(steps))
        slopes = np.ascontiguousarray(((ahead - now) / steps[:, None, None, None])[:, :, :3])
        rest = np.ascontiguousarray(self.rest(parameters)[chosen])
        bones, weights = self.skin.bones[chosen], self.skin.weights[chosen].astype(np.float64)
        basis = np.ascontiguousarray(self._basis[chosen])
        return np.asarray(_derivatives(rest, bones, weights, basis, now, slopes))


def _soles(space: BodySpace, skin: Skin) -> LandmarkModel:
    """The points of both feet that are lowest at rest, below heel and ball."""
    names = np.array(space.names)[skin.bones[:, 0]]
    at = []
    for joint in ("LeftFoot", "RightFoot", "LeftToeBase", "RightToeBase"):
        own = np.flatnonzero(names == joint)
        at.append(own[np.argmin(space.mean[skin.vertices[own], 1])])
    vertices = skin.vertices[at]
    joints = skin.bones[at, 0].astype(np.intp)
    return LandmarkModel(tuple(names[at]), joints, space.mean[vertices], space.basis[:, vertices])


@njit(parallel=True, nogil=True, boundscheck=False)
def _derivatives(rest, bones, weights, basis, now, slopes):  # type: ignore[no-untyped-def]
    parameters, shapes = len(slopes), basis.shape[1]
    out = np.zeros((len(rest), 3, parameters))
    for v in prange(len(rest)):
        x, y, z = rest[v, 0], rest[v, 1], rest[v, 2]
        for k in range(bones.shape[1]):
            w = weights[v, k]
            if w == 0:
                continue
            bone = bones[v, k]
            for p in range(parameters):
                for axis in range(3):
                    m = slopes[p, bone, axis]
                    out[v, axis, p] += w * (m[0] * x + m[1] * y + m[2] * z + m[3])
            for c in range(shapes):
                for axis in range(3):
                    m = now[bone, axis]
                    moved = m[0] * basis[v, c, 0] + m[1] * basis[v, c, 1] + m[2] * basis[v, c, 2]
                    out[v, axis, parameters - shapes + c] += w * moved
    return out
