"""The film of a person as they are in one photograph, frame by frame: what `engine.face_animation` draws of it, retouched."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.acting_options import ActingOptions
from engine.face_animation.animation import FaceAnimation, RegisteredDriver, RiggedTarget, draw_in_order
from engine.face_animation.creases.fine_details import RatioStrip
from engine.face_animation.motion_transfer.control_motion import ControlMotion, carry_motion
from engine.face_animation.motion_transfer.head_proxy import build_head_proxy
from engine.perception.expression.features import frontalise
from engine.perception.face.landmarks import MESH_SIZE
from engine.persona.composite.retouching import Retouching
from engine.persona.persona import Persona
from engine.persona.texture.appearance_subspace import REFERENCE_WIDTH_PIXELS
from engine.persona.texture.expression_weights import SMOOTHING_FRAMES, expression_points, expression_weights

PHOTO_TEXTURES_AT_ONCE = 8
"""Textures that are made at once: so few that frames are drawn meanwhile."""


@dataclass(frozen=True)
class PhotoActing:
    """What a photograph's face does in F frames.

    motions : of its control points.
    faces : (F, 478, 2) where that puts it, pixels.
    depths : (F, 478), smaller is nearer.
    weights : (F, N) how much each of the persona's photographs counts.
    rest : (N,) the same for the expression that the photograph shows.
    """

    motions: tuple[ControlMotion, ...]
    faces: NDArray[np.float32]
    depths: NDArray[np.float32]
    weights: NDArray[np.float32]
    rest: NDArray[np.float32]


def act(
    target: RiggedTarget,
    driver: RegisteredDriver,
    options: ActingOptions,
    persona: Persona,
    smoothing: float = SMOOTHING_FRAMES,
) -> PhotoActing:
    """What the photograph's face does when it follows the driver. The expression is read off its own face as it moves, so that
    nothing has to be carried from the driver's to the persona's. `smoothing` : of the photographs' weights, in frames."""
    control, mesh = target.rig.control, target.face.mesh
    proxy = build_head_proxy(control.points, mesh) if options.head_3d else None
    motions = tuple(carry_motion(driver.track, driver.neutral, mesh, control, proxy, options, driver.residuals))
    faces = np.array([control.points[:MESH_SIZE] + motion.offsets[:MESH_SIZE] for motion in motions], np.float32)
    depths = np.array([motion.depth[:MESH_SIZE] for motion in motions], np.float32)
    front = frontalise(np.concatenate([faces, depths[..., None]], axis=-1))
    scale = persona.frame.scale * REFERENCE_WIDTH_PIXELS / persona.frame.size[1]
    shown, known = expression_points(front) * scale, persona.points * scale
    rest = expression_weights(shown[driver.neutral][None], known)[0]
    return PhotoActing(motions, faces, depths, expression_weights(shown, known, smoothing), rest)


def photo_frames(
    animation: FaceAnimation,
    retouching: Retouching,
    persona: Persona,
    acting: PhotoActing,
) -> Iterator[NDArray[np.uint8]]:
    """(h, w, 3) the frames of a film, drawn side by side on all cores."""
    none = RatioStrip().ratio(0)

    def draw(motion: ControlMotion, texture: NDArray[np.uint8]) -> NDArray[np.uint8]:
        frame = animation.draw(motion, none)
        retouching(frame, acting.faces[motion.frame], acting.depths[motion.frame], texture)
        return frame

    return draw_in_order(draw, zip(acting.motions, _textures(persona, acting.weights), strict=True))


def _textures(persona: Persona, weights: NDArray[np.float32]) -> Iterator[NDArray[np.uint8]]:
    for start in range(0, len(weights), PHOTO_TEXTURES_AT_ONCE):
        yield from persona.synthesis(weights[start : start + PHOTO_TEXTURES_AT_ONCE])
