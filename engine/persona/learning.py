"""From the faces that were kept to a persona: sections 4 and 5, but for what a driver's frame asks for."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.perception.expression.features import frontalise
from engine.perception.face.landmarks import LIPS_INNER, mouth_opening
from engine.persona.collection.rest import at_rest
from engine.persona.persona import Persona
from engine.persona.shape.average_shape import average_depth
from engine.persona.shape.parallax import depth_by_parallax
from engine.persona.texture.aligned_photos import AlignedPhotos, align_photos
from engine.persona.texture.appearance_subspace import Appearance, appearance, exposed
from engine.persona.texture.bare_skin import bared
from engine.persona.texture.dense_alignment import align_densely, shifted
from engine.persona.texture.expression_weights import expression_points
from engine.persona.texture.template_shape import template_shape
from engine.persona.texture.texture_frame import TextureFrame, texture_frame
from engine.persona.texture.white_balance import balanced

MOUTH_OPENING = 0.25
"""From which on what a photograph shows between the lips counts in full: of a mouth that is shut it is the lips' own rim, drawn wide."""
MIN_BELIEVED = 0.45
"""The least share of what a photograph shows from the brows down that can be believed. Where it is less, hands, beards,
spectacles or a light of its own cover the face, or it is painted. Caps leave more."""
BROW_TOP_VERTICES = (105, 334)
"""Vertices at the tops of the brows' arches."""

TOWARDS_FAR = np.array([0.0, 0.0, 1.0])
"""Away from the viewer."""


@dataclass(frozen=True)
class LearntPersona:
    """A persona, and which of the N photographs it is of, (N,): not those in which next to nothing can be believed."""

    persona: Persona
    used: NDArray[np.bool_]


def learn_persona(
    meshes: NDArray[np.floating],
    photo: Callable[[int], NDArray[np.uint8]],
    size: tuple[int, int],
    tick: Callable[[float], None] = lambda fraction: None,
    insisted: Collection[int] = (),
) -> LearntPersona:
    """Of `meshes` (N, 478, 3) in the photographs that `photo` gives by number, (h, w, 3) uint8; textures of `size` (height, width). Those
    that are `insisted` on are used however little of them can be believed."""
    mesh = template_shape(meshes)
    frame = texture_frame(mesh, size)
    laid = align_photos(frame, list(meshes), photo, lambda fraction: tick(0.3 * fraction))
    mouths = _mouths(frame, mouth_opening(frontalise(meshes)))
    aligned = bared(frame, laid)
    tick(0.4)
    shown = aligned.shown * mouths
    first = appearance(exposed(aligned.grey(), frame.face), shown, frame.covered)
    used = believed_share(frame, first, laid.shown * mouths) >= MIN_BELIEVED
    used[list(insisted)] = True
    if not used.all():
        aligned, shown, meshes = AlignedPhotos(aligned.colours[used], aligned.shown[used]), shown[used], meshes[used]
        first = appearance(first.exposed[used], shown, frame.covered)
    front = frontalise(meshes)
    offsets, seen = align_densely(first, shown, frame.covered, lambda fraction: tick(0.4 + 0.5 * fraction))
    colours = _moved(AlignedPhotos(balanced(aligned.colours, seen.weights, frame.face), shown), offsets)
    deeper = depth_by_parallax(frame, meshes, offsets, seen.weights)[:, None] * TOWARDS_FAR
    depth = average_depth(texture_frame(mesh + deeper, size), seen)
    tick(1.0)
    belief = np.rint(seen.weights * 255).astype(np.uint8)
    points = expression_points(front).astype(np.float32)
    persona = Persona(mesh + deeper, at_rest(front) + deeper, colours, belief, points, depth.astype(np.float32))
    return LearntPersona(persona, used)


def believed_share(frame: TextureFrame, seen: Appearance, shown: NDArray[np.float32]) -> NDArray[np.float64]:
    """(N,) how much of what each photograph shows of the face, from the brows down and beside the lips' inside, can be believed."""
    below = np.arange(frame.size[0])[:, None] > frame.places[list(BROW_TOP_VERTICES), 1].min()
    inner = frame.face & below & ~_between_lips(frame)
    believed, there = seen.weights[:, inner].sum(axis=1), shown[:, inner].sum(axis=1)
    return np.asarray(believed / np.maximum(there, 1e-6), np.float64)


def _mouths(frame: TextureFrame, openings: NDArray[np.floating]) -> NDArray[np.float32]:
    """(N, H, W) how far each photograph counts: less between the lips, the less its mouth is open."""
    share = np.minimum(np.asarray(openings) / MOUTH_OPENING, 1) ** 2
    return np.where(_between_lips(frame)[None], share[:, None, None], 1).astype(np.float32)


def _between_lips(frame: TextureFrame) -> NDArray[np.bool_]:
    inside = np.zeros(frame.size, np.uint8)
    cv2.fillPoly(inside, [np.rint(frame.places[list(LIPS_INNER), :2]).astype(np.int32)], 1)
    return inside > 0


def _moved(photos: AlignedPhotos, offsets: NDArray[np.float32]) -> NDArray[np.uint8]:
    out = np.empty_like(photos.colours)
    for target, colours, offset in zip(out, photos.colours, offsets, strict=True):
        target[:] = np.clip(np.rint(shifted(colours, offset, cv2.INTER_CUBIC)), 0, 255)
    return out
