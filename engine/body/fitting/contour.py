"""A person's contour as a target of fitting: where the body should reach to, seen in the picture.

Each point of the mask's contour asks for the outermost part of the body that faces the same way nearby. People wear
clothes: a body may stay behind the contour, but must not stand out of it (cf. the interpenetration of body and mask in
C. Lassner et al., Unite the People, 2017, which counts both ways alike).
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from engine.body.body_space import BodySpace
from engine.body.rig import Rig
from engine.body.template import Template
from engine.geometry.mesh.surface import triangulate, vertex_normals

CONTOUR_POINTS = 240
"""Points along a contour."""
MIN_GAP_STEPS = 8.0
"""Steps of the contour around a gap in the mask, at least, for it to count: between arm and trunk, or both legs."""
DIRECTION_SMOOTHING_STEPS = 2.0
"""Steps of the contour over which its direction is averaged."""
MIN_CONTOUR_NORMAL_COSINE = 0.6
"""The least cosine between the contour's normal and the body's in the picture, for the two to be matched."""
MAX_NORMAL_DEPTH = 0.75
"""The most of the body's normal that may point at the viewer or away: where a contour runs, the body lies across the view."""
SEARCH_HALF_WIDTH_SHARE = 0.01
"""Half the width of the strip in which a contour's point looks for the body, as a share of the person's height."""
SEARCH_INSIDE_SHARE = 0.06
"""How far inside the contour the body may be to be matched, as a share of the person's height."""
SEARCH_OUTSIDE_SHARE = 0.03
"""How far outside the contour the body may be to be matched, as a share of the person's height."""
FOOT_JOINTS, FEET_SEARCH_INSIDE_SHARE = ("Foot", "Toe"), 0.1
"""Joints of feet, and how far inside the contour a foot may be to be matched, as a share of the person's height.
Perception has feet too high on long legs: a leg ends where its outline ends."""
UNMATCHED_JOINTS = ("Head", "Neck", "Hand", "Thumb", "Index", "Middle", "Ring", "Pinky")
"""Joints whose surface is not matched: hair and fingers have contours of their own."""
VERTEX_STRIDE = 2
"""One of so many vertices of the template is looked at."""


@dataclass(frozen=True)
class Contour:
    """A mask's contour: `points` (M, 2) pixels along it, and its `normals` (M, 2) there, outwards."""

    points: NDArray[np.float64]
    normals: NDArray[np.float64]


@dataclass(frozen=True)
class SkinPoints:
    """Points of the template's surface, each carried by one joint.

    joints : (S,) which carries each.
    mean : (S, 3) metres, where they are at rest.
    basis : (K, S, 3) metres, how that moves with each coefficient.
    normals : (S, 3) the mean body's, unit vectors.
    inside : (S,) how far inside a contour each may be that meets it, as a share of the person's height.
    """

    joints: NDArray[np.intp]
    mean: NDArray[np.float32]
    basis: NDArray[np.float32]
    normals: NDArray[np.float32]
    inside: NDArray[np.float32]

    def subset(self, chosen: NDArray[np.intp]) -> SkinPoints:
        """Those with the numbers `chosen`."""
        return SkinPoints(
            self.joints[chosen], self.mean[chosen], self.basis[:, chosen], self.normals[chosen], self.inside[chosen]
        )


def skin_points(template: Template, space: BodySpace, rig: Rig) -> SkinPoints:
    """Points all over trunk, arms, legs and feet."""
    normals = vertex_normals(space.mean, triangulate(template.quads[template.faces("body")]))
    body = template.vertices_of("body")[::VERTEX_STRIDE].astype(np.intp)
    carried = [k for k in body if not any(leaf in rig.names[rig.bones[k, 0]] for leaf in UNMATCHED_JOINTS)]
    chosen = np.array(carried, np.intp)
    carrying = [rig.names[bone] for bone in rig.bones[chosen, 0]]
    at = np.array([space.names.index(name) for name in carrying])
    inside = [
        FEET_SEARCH_INSIDE_SHARE if any(leaf in name for leaf in FOOT_JOINTS) else SEARCH_INSIDE_SHARE
        for name in carrying
    ]
    return SkinPoints(at, space.mean[chosen], space.basis[:, chosen], normals[chosen], np.array(inside, np.float32))


def trace_contour(mask: NDArray[np.bool_]) -> Contour:
    """The contour of the largest piece of a mask (H, W), and of the gaps in it, at even steps; what the picture's border cuts is
    left out."""
    height, width = mask.shape
    found, tree = cv2.findContours(mask.astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    own = max((k for k in range(len(found)) if tree[0, k, 3] < 0), key=lambda k: len(found[k]))
    step = len(found[own]) / CONTOUR_POINTS
    lines = [(found[own][:, 0], 1.0)]
    lines += [
        (found[k][:, 0], -1.0)
        for k in range(len(found))
        if tree[0, k, 3] == own and len(found[k]) > MIN_GAP_STEPS * step
    ]
    parts = [_along(line.astype(np.float64), step, way) for line, way in lines]
    points, normals = (np.concatenate([part[k] for part in parts]) for k in range(2))
    within = ((points > 1) & (points < [width - 2, height - 2])).all(1)
    return Contour(points[within], normals[within])


def _along(line: NDArray[np.float64], step: float, way: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points (M, 2) at even steps of a closed line (L, 2), and the normals there: outwards where `way` is 1, inwards where -1."""
    steps = np.linspace(0, len(line), round(len(line) / step), endpoint=False).astype(int)
    smooth = gaussian_filter1d(line, DIRECTION_SMOOTHING_STEPS * step, axis=0, mode="wrap")
    along = np.roll(smooth, -1, 0) - np.roll(smooth, 1, 0)
    normals = np.stack([-along[:, 1], along[:, 0]], 1)
    signed = float(((line - line.mean(0)) * normals).sum())  # positive where they point outwards
    normals *= way * np.sign(signed) / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    return line[steps], normals[steps]


def match_contour(
    contour: Contour,
    pixels: NDArray[np.float64],
    normals: NDArray[np.float64],
    inside: NDArray[np.floating],
    height: float,
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Which points of the contour meet which points of the body, both (R,).

    Parameters
    ----------
    pixels : (S, 2) the body's points in the picture; `normals` (S, 3) there: x right, y down, z to the viewer.
    inside : (S,) as in `SkinPoints`.
    height : of the person, pixels.
    """
    away = pixels[None] - contour.points[:, None]
    across = (away * contour.normals[:, None]).sum(-1)
    along = away[..., 0] * contour.normals[:, None, 1] - away[..., 1] * contour.normals[:, None, 0]
    flat = normals[:, :2] / np.maximum(np.linalg.norm(normals[:, :2], axis=1, keepdims=True), 1e-9)
    meant = (
        (np.abs(along) < SEARCH_HALF_WIDTH_SHARE * height)
        & (across > -inside * height)
        & (across < SEARCH_OUTSIDE_SHARE * height)
    )
    meant &= (contour.normals @ flat.T > MIN_CONTOUR_NORMAL_COSINE) & (np.abs(normals[:, 2]) < MAX_NORMAL_DEPTH)
    outermost = np.where(meant, across, -np.inf).argmax(1)
    which = np.flatnonzero(meant.any(1))
    return which, outermost[which]
