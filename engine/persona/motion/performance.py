"""A driver's performance as the puppet plays it: "B's shape, B's texture, A's motion (adjusted to B's face)"."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.rigid import fit_similarities
from engine.perception.expression.features import frontalise
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import RIGID_VERTICES, eye_distance
from engine.persona.motion.deformation_transfer import DeformationTransfer
from engine.persona.persona import Persona
from engine.persona.texture.expression_weights import SMOOTHING_FRAMES
from engine.persona.texture.texture_frame import texture_frame

FRAME_SIZE = (244, 194)
"""Height and width of the frames in which movements are compared, pixels: the paper's, however fine the texture is."""


@dataclass(frozen=True)
class Performance:
    """F frames of a puppet.

    faces : (F, 478, 3) float64 from the front, in eye distances.
    weights : (F, N) float32, how much each photograph counts.
    linear : (F, 3, 3) how the driver's head is turned, pixels of its video for eye distances.
    shift : (F, 3) where it is, pixels of its video.
    """

    faces: NDArray[np.float64]
    weights: NDArray[np.float32]
    linear: NDArray[np.float64]
    shift: NDArray[np.float64]


def perform(
    persona: Persona,
    meshes: NDArray[np.floating],
    driver: NDArray[np.floating],
    tick: Callable[[float], None] = lambda fraction: None,
) -> Performance:
    """What the puppet does when the driver's face does `meshes` (F, 478, 3), pixels of its video; at rest this is `driver` (478, 3), from
    the front, in eye distances."""
    front = frontalise(meshes)
    transfer = DeformationTransfer(texture_frame(driver, FRAME_SIZE), texture_frame(persona.neutral, FRAME_SIZE))
    faces = persona.neutral + transfer.of_frames(front - driver, tick)
    weights = persona.weights(faces, SMOOTHING_FRAMES)
    linear, shift = placings(meshes)
    return Performance(faces, weights, linear, shift)


def placings(meshes: NDArray[np.floating]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(F, 3, 3) and (F, 3) that carry faces from the front, in eye distances, to where the meshes are."""
    chosen = list(RIGID_VERTICES)
    model = canonical_face()[chosen].astype(np.float64)
    _, rotation, shift = fit_similarities(model, np.asarray(meshes, np.float64)[:, chosen], np.ones(len(chosen)))
    turned_back = np.einsum("nji,nvj->nvi", rotation, meshes - shift[:, None])
    return rotation * eye_distance(turned_back)[:, None, None], shift
