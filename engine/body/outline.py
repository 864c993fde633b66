"""A person's outline as a target of fitting: where the body should reach to, seen in the picture.

Each point of the mask's outline asks for the outermost part of the body that faces the same way nearby. People wear
clothes: a body may stay behind the outline, but must not stand out of it (cf. the interpenetration of body and mask in
C. Lassner et al., Unite the People, 2017, which counts both ways alike).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from engine.body.body_space import BodySpace
from engine.body.rig import Rig
from engine.body.template import Template
from engine.geometry.surface import triangulate, vertex_normals

POINTS = 240
"""Points along an outline."""
SMOOTH = 2.0
"""Steps of the outline over which its direction is averaged."""
ALIKE = 0.6
"""The least cosine between the outline's normal and the body's in the picture ..."""
EDGE_ON = 0.75
"""... and how far the body's may point at the viewer or away: where an outline runs, it lies across the view."""
WINDOW = 0.01
"""Half the width of the strip in which an outline's point looks for the body, as a share of the person's height."""
INSIDE, OUTSIDE = 0.06, 0.03
"""How far the body may be from the outline to be meant, likewise."""
LEAVES = ("Head", "Neck", "Hand", "Foot", "Toe", "Thumb", "Index", "Middle", "Ring", "Pinky")
"""Joints whose surface asks for nothing: hair, fingers and shoes have outlines of their own."""
EVERY = 2
"""One of so many vertices of the template is looked at."""


@dataclass(frozen=True)
class Outline:
    """`points` (M, 2) pixels along the mask's outline and its `normals` (M, 2), outwards."""

    points: NDArray[np.float64]
    normals: NDArray[np.float64]


@dataclass(frozen=True)
class Skin:
    """Points of the template's surface, each carried by one joint, at rest and linear in the coefficients: `joints` (S,),
    `mean` (S, 3), `basis` (K, S, 3) as in `engine.body.landmarks.LandmarkModel`; `normals` (S, 3) of the mean body."""

    joints: NDArray[np.intp]
    mean: NDArray[np.float32]
    basis: NDArray[np.float32]
    normals: NDArray[np.float32]

    def some(self, chosen: NDArray[np.intp]) -> Skin:
        """Those with the numbers `chosen`."""
        return Skin(self.joints[chosen], self.mean[chosen], self.basis[:, chosen], self.normals[chosen])


def skin_model(template: Template, space: BodySpace, rig: Rig) -> Skin:
    """Points all over trunk, arms and legs."""
    normals = vertex_normals(space.mean, triangulate(template.quads[template.faces("body")]))
    body = template.vertices_of("body")[::EVERY].astype(np.intp)
    carried = [k for k in body if not any(leaf in rig.names[rig.bones[k, 0]] for leaf in LEAVES)]
    chosen = np.array(carried, np.intp)
    at = np.array([space.names.index(rig.names[bone]) for bone in rig.bones[chosen, 0]])
    return Skin(at, space.mean[chosen], space.basis[:, chosen], normals[chosen])


def trace(mask: NDArray[np.bool_]) -> Outline:
    """The outline of the largest piece of a mask (H, W), at even steps; what the picture's border cuts is left out."""
    height, width = mask.shape
    found: Sequence[NDArray[np.int32]] = cv2.findContours(  # type: ignore[assignment]
        mask.astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE
    )[0]
    line = max(found, key=len)[:, 0].astype(np.float64)
    steps = np.linspace(0, len(line), POINTS, endpoint=False).astype(int)
    width_of_mean = SMOOTH * len(line) / POINTS
    smooth = gaussian_filter1d(line, width_of_mean, axis=0, mode="wrap")
    along = np.roll(smooth, -1, 0) - np.roll(smooth, 1, 0)
    normals = np.stack([-along[:, 1], along[:, 0]], 1)
    signed = float(((line - line.mean(0)) * normals).sum())  # positive where they point outwards
    normals *= np.sign(signed) / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    points, normals = line[steps], normals[steps]
    within = ((points > 1) & (points < [width - 2, height - 2])).all(1)
    return Outline(points[within], normals[within])


def meet(
    outline: Outline, pixels: NDArray[np.float64], normals: NDArray[np.float64], height: float
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Which points of the outline meet which points of the body, both (R,).

    Parameters
    ----------
    pixels : (S, 2) the body's points in the picture; `normals` (S, 3) there: x right, y down, z to the viewer.
    height : of the person, pixels.
    """
    away = pixels[None] - outline.points[:, None]
    across = (away * outline.normals[:, None]).sum(-1)
    along = away[..., 0] * outline.normals[:, None, 1] - away[..., 1] * outline.normals[:, None, 0]
    flat = normals[:, :2] / np.maximum(np.linalg.norm(normals[:, :2], axis=1, keepdims=True), 1e-9)
    meant = (np.abs(along) < WINDOW * height) & (across > -INSIDE * height) & (across < OUTSIDE * height)
    meant &= (outline.normals @ flat.T > ALIKE) & (np.abs(normals[:, 2]) < EDGE_ON)
    outermost = np.where(meant, across, -np.inf).argmax(1)
    which = np.flatnonzero(meant.any(1))
    return which, outermost[which]
