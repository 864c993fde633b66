"""How near a persona's shape is to the true one, of collections that are rendered of known heads under many lights.

The error is that of depth, after the best similarity, in shares of the face's width. It is told of the persona, of the
tracker's meshes in the mean and of the general face.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.persona_figures.known_heads import KnownHead, from_before, head_scan, photographs, template_person
from benchmarks.presentation.tables import table
from engine.geometry.registration.rigid import fit_similarities, fit_similarity
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import FACE_OVAL, RIGID_VERTICES
from engine.persona.learning import learn_persona
from engine.persona.motion.performance import FRAME_SIZE
from engine.persona.persona import Persona
from engine.persona.texture.template_shape import template_shape
from engine.persona.texture.texture_frame import TextureFrame
from engine.render.rasterisation.rasteriser import rasterise

PHOTO_COUNT = 60


def shape() -> None:
    """Print the table."""
    rows = []
    for head in (head_scan(), *(template_person(name) for name in ("template-a", "template-b"))):
        meshes, photos = photographs(head, PHOTO_COUNT, np.random.default_rng(5))
        learnt = learn_persona(meshes, photos.__getitem__, FRAME_SIZE)
        ours, mesh, general = _errors(head, learnt.persona, template_shape(meshes[learnt.used]))
        best = min(mesh, general)
        rows.append([head.name, f"{ours:.2f}", f"{mesh:.2f}", f"{general:.2f}", f"{100 * (1 - ours / best):.0f}%"])
    head_row = ["head", "persona", "landmark mesh", "general face", "below the better of both"]
    print(table(f"Depth error, % of the face's width, {PHOTO_COUNT} photographs; goal 10% below", head_row, rows))


def _errors(head: KnownHead, persona: Persona, tracked: NDArray[np.float64]) -> tuple[float, float, float]:
    """Of the persona's depth, the landmark mesh's, `tracked` (478, 3) in the mean, and the general face's."""
    frame = persona.frame
    mesh, seen = from_before(head)
    chosen = list(RIGID_VERTICES)
    laid = fit_similarity(mesh[chosen, :2].astype(np.float64), frame.places[chosen, :2])
    scale = float(np.sqrt(np.linalg.det(laid.linear)))
    placed = np.column_stack([seen[:, :2] @ laid.linear.T + laid.shift, seen[:, 2] * scale])
    true = rasterise(placed, head.triangles, frame.size).depth
    area = cv2.erode(frame.face.astype(np.uint8), np.ones((15, 15))) > 0
    area &= np.isfinite(true)
    width = float(np.ptp(frame.places[list(FACE_OVAL), 0]))
    depths = (persona.depth, *(_depth(frame, mesh) for mesh in (tracked, canonical_face())))
    ours, landmark, general = (100 * _error(depth, true, area) / width for depth in depths)
    return ours, landmark, general


def _depth(frame: TextureFrame, mesh: NDArray[np.floating]) -> NDArray[np.float32]:
    """(H, W) pixels, of a `mesh` (478, 3) in eye distances."""
    depth = np.concatenate([mesh[:, 2], mesh[list(FACE_OVAL), 2]]) * frame.scale
    return frame.interpolated(depth[:, None])[..., 0]


def _error(depth: NDArray[np.floating], true: NDArray[np.floating], area: NDArray[np.bool_]) -> float:
    """Mean distance in depth, pixels, of what is in the `area` after a similarity."""
    rows, columns = np.nonzero(area)
    given = np.column_stack([columns, rows, depth[area]]).astype(np.float64)
    goal = np.column_stack([columns, rows, true[area]]).astype(np.float64)
    scale, rotation, shift = fit_similarities(given, goal[None], np.ones(len(given)))
    moved = scale[0] * given @ rotation[0].T + shift[0]
    return float(np.abs(moved - goal)[:, 2].mean())
