"""From the faces that were kept to a persona: sections 4 and 5, but for what a driver's frame asks for."""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.perception.expression.features import frontalise
from engine.perception.landmarks import LIPS_INNER, mouth_opening
from engine.persona.persona import Persona
from engine.persona.shape.average_shape import average_depth
from engine.persona.texture.aligned_photos import AlignedPhotos, align_photos
from engine.persona.texture.appearance_subspace import appearance, exposed
from engine.persona.texture.dense_alignment import align_densely, shifted
from engine.persona.texture.expression_weights import expression_points
from engine.persona.texture.template_shape import template_shape
from engine.persona.texture.texture_frame import TextureFrame, texture_frame
from engine.persona.texture.white_balance import balanced

MOUTH_OPENING = 0.25
"""From which on what a photograph shows between the lips counts in full: of a mouth that is shut it is the lips' own rim, drawn wide."""
NEUTRAL_SHARE = 0.25
"""Of the photographs, those whose expression is nearest to the median one: their mean is the face at rest."""


def learn_persona(
    meshes: NDArray[np.floating],
    photo: Callable[[int], NDArray[np.uint8]],
    size: tuple[int, int],
    tick: Callable[[float], None] = lambda fraction: None,
) -> Persona:
    """Of `meshes` (N, 478, 3) in the photographs that `photo` gives by number, (h, w, 3) uint8; textures of `size` (height, width)."""
    front = frontalise(meshes)
    mesh = template_shape(meshes)
    frame = texture_frame(mesh, size)
    aligned = align_photos(frame, list(meshes), photo, lambda fraction: tick(0.4 * fraction))
    shown = aligned.shown * _mouths(frame, mouth_opening(front))
    first = appearance(exposed(aligned.grey(), frame.face), shown, frame.covered)
    offsets, seen = align_densely(first, shown, frame.covered, lambda fraction: tick(0.4 + 0.5 * fraction))
    colours = _moved(AlignedPhotos(balanced(aligned.colours, seen.weights, frame.face), shown), offsets)
    depth = average_depth(frame, seen)
    tick(1.0)
    return Persona(
        mesh,
        _neutral(front),
        colours,
        np.rint(seen.weights * 255).astype(np.uint8),
        expression_points(front).astype(np.float32),
        depth.astype(np.float32),
    )


def _mouths(frame: TextureFrame, openings: NDArray[np.floating]) -> NDArray[np.float32]:
    """(N, H, W) how far each photograph counts: less between the lips, the less its mouth is open."""
    inside = np.zeros(frame.size, np.uint8)
    cv2.fillPoly(inside, [np.rint(frame.places[list(LIPS_INNER), :2]).astype(np.int32)], 1)
    share = np.minimum(np.asarray(openings) / MOUTH_OPENING, 1) ** 2
    return np.where(inside[None] > 0, share[:, None, None], 1).astype(np.float32)


def _moved(photos: AlignedPhotos, offsets: NDArray[np.float32]) -> NDArray[np.uint8]:
    out = np.empty_like(photos.colours)
    for target, colours, offset in zip(out, photos.colours, offsets, strict=True):
        target[:] = np.clip(np.rint(shifted(colours, offset, cv2.INTER_CUBIC)), 0, 255)
    return out


def _neutral(front: NDArray[np.float64]) -> NDArray[np.float64]:
    """(478, 3) the mean of the faces that show least: those nearest to the median of all, and with the mouth shut as most have it."""
    points = expression_points(front)
    off = ((points - np.median(points, axis=0)) ** 2).sum(axis=(1, 2))
    order = np.argsort(off + np.asarray(mouth_opening(front)) ** 2)
    return np.asarray(front[order[: max(int(NEUTRAL_SHARE * len(front)), 1)]].mean(axis=0))
