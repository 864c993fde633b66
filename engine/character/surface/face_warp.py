"""The warp of the head that takes the picture's fiducials exactly to the template's (the paper's section 5)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RBFInterpolator

from engine.body.parts import BODY_PARTS
from engine.character.figure.face_region import in_profile
from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import Silhouette
from engine.character.fit.posed_template import PosedTemplate
from engine.character.parts.label_map import Labels
from engine.character.surface.part_surface import Warp
from engine.perception.face.landmarks import JAW_LANDMARK_COUNT, fiducials

FIXED_POINT_SPACING_PIXELS = 8
"""Pixels between the points of the head's border that stay."""


@dataclass(frozen=True)
class Face:
    """Fiducials on the grid, (n, 2) each: where they are `seen`, and where the template has them (`laid`). `head` (h, w):
    the pixels that are moved."""

    seen: NDArray[np.float64]
    laid: NDArray[np.float64]
    head: NDArray[np.bool_]


def with_face(warp: Warp, face: Face) -> Warp:
    """A warp (`engine.character.surface.part_surface.warp_part`) changed within the head, smoothly, by thin plates: what is seen at a
    fiducial is looked up at the template's, and at the head's border nothing changes."""
    height, width = face.head.shape
    at = np.rint(face.seen).astype(int)
    x, y = np.clip(at, 0, [width - 1, height - 1]).T
    inside = np.asarray((at == np.stack([x, y], 1)).all(1) & face.head[y, x])
    if inside.sum() < 4:
        return warp
    seen, laid = face.seen[inside], face.laid[inside]
    columns, rows = (np.ascontiguousarray(seen[:, k], np.float32)[:, None] for k in range(2))
    now = cv2.remap(np.ascontiguousarray(warp.places), columns, rows, cv2.INTER_LINEAR)[:, 0]
    inner = cv2.erode(face.head.astype(np.uint8), np.ones((3, 3), np.uint8), borderValue=0) > 0
    rim = np.argwhere(face.head & ~inner)[::FIXED_POINT_SPACING_PIXELS, ::-1].astype(np.float64)
    moved = RBFInterpolator(
        np.concatenate([seen, rim]), np.concatenate([laid - now, np.zeros_like(rim)]), kernel="thin_plate_spline"
    )
    ys, xs = np.nonzero(inner)
    places = warp.places.copy()
    places[ys, xs] += moved(np.stack([xs, ys], 1).astype(np.float64)).astype(np.float32)
    return replace(warp, places=places)


def seen_face(
    figure: Figure, silhouette: Silhouette, template: PosedTemplate, points: NDArray[np.intp], labels: Labels
) -> Face | None:
    """The face of a `figure` on the grid of its `silhouette` and `labels`; None where none is seen, or it is in profile. `points` (68,): the
    `template`'s vertices at a face's points."""
    if figure.face is None or in_profile(figure):
        return None
    seen = fiducials(figure.face[:, :2])[JAW_LANDMARK_COUNT:].astype(np.float64)
    on_grid = seen @ silhouette.to_grid[:, :2].T + silhouette.to_grid[:, 2]
    return Face(on_grid, template.vertices[points[JAW_LANDMARK_COUNT:], :2], labels.labels == BODY_PARTS.index("head"))
