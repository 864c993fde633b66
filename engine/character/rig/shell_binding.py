"""A shell bound to its skeleton: it comes from the template, and so its weights and the way to T-pose are known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import Silhouette
from engine.character.fit.rest_skeleton import pictured_joints
from engine.character.fit.template_fit import FittedBody, load_human
from engine.character.rig.rigging import Character, at_rest, pictured_clip
from engine.character.shell.piece import Piece
from engine.character.shell.shell import Shell
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.imaging.masks.mask_pieces import bounding_box

MIXED_COLOUR_BAND_PIXELS = 1.5
"""Pixels of the grid within the outline from which on its colours are the person's alone."""
CROP_MARGIN_PIXELS = 4
"""Pixels of the picture around the person that go into the texture."""


def bind_shell(
    shell: Shell, figure: Figure, silhouette: Silhouette, fitted: FittedBody, texture: NDArray[np.uint8]
) -> Character:
    """The character of a shell, with a texture (H, W, 3) in the template's chart. Where it has pieces beside the template, the
    picture goes into the texture beside that, too."""
    mesh, corners = shell.mesh, shell.mesh.corners
    camera = silhouette.camera(fitted.picture_camera())
    seen = [shell.pictured, *(piece.vertices for piece in shell.pieces)]
    eye = np.array([0.0, -min(camera.to_metres(one)[:, 1].min() for one in seen), camera.distance])
    joints = pictured_joints(fitted, load_human().space).seen_from(eye)
    transforms = joints.transforms()
    parts = [_Part(shell.rest[corners], mesh.uv_triangles, mesh.uv, mesh.bones[corners], mesh.weights[corners])]
    if shell.pieces:
        beside = _Beside(figure, silhouette, texture, shell.pieces)
        texture = beside.texture
        parts[0] = parts[0].charted(beside.of_chart(mesh.uv))
        for piece in shell.pieces:
            places, weights, _ = at_rest(camera.to_metres(piece.vertices) + eye, piece.bones, piece.weights, transforms)
            parts.append(_Part(places, piece.triangles, beside.of_piece(piece), piece.bones, weights))
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    vertices = np.concatenate([part.vertices for part in parts])
    lift = np.array([0.0, -shell.rest[:, 1].min(), 0.0])
    bound = SkinnedMesh(
        joints.lifted(lift),
        (vertices + lift).astype(np.float32),
        np.concatenate([part.triangles + start for part, start in zip(parts, starts, strict=False)]).astype(np.int32),
        np.concatenate([part.uv for part in parts]).astype(np.float32),
        np.concatenate([part.bones for part in parts]).astype(np.uint8),
        np.concatenate([part.weights for part in parts]).astype(np.float32),
        texture,
    )
    return Character(bound, pictured_clip(joints), eye)


@dataclass(frozen=True)
class _Part:
    """What of a mesh comes from one place, as `engine.geometry.rigging.skinned_mesh.SkinnedMesh` has it.

    vertices : (V, 3) metres.
    triangles : (T, 3).
    uv : (V, 2) places on the texture.
    bones : (V, 4) the joints that carry each.
    weights : (V, 4) float32, how much each of these does.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int32]
    uv: NDArray[np.floating]
    bones: NDArray[np.intp]
    weights: NDArray[np.float32]

    def charted(self, uv: NDArray[np.floating]) -> _Part:
        return _Part(self.vertices, self.triangles, uv, self.bones, self.weights)


class _Beside:
    """A `texture` of the template's chart and, to its right, the picture around the person, who goes on beyond their outline in the colours
    next to it; and then what pieces have of their own."""

    def __init__(
        self, figure: Figure, silhouette: Silhouette, chart: NDArray[np.uint8], pieces: Sequence[Piece]
    ) -> None:
        self.to_picture = np.linalg.inv(np.vstack([silhouette.to_grid, [0, 0, 1]]))[:2]
        within = distance_transform_edt(silhouette.alpha > 0.5) > MIXED_COLOUR_BAND_PIXELS / float(
            silhouette.to_grid[0, 0]
        )
        nearest = distance_transform_edt(~within, return_distances=False, return_indices=True)
        rows, columns = bounding_box(silhouette.alpha > 0.5, CROP_MARGIN_PIXELS)
        self.first = np.array([columns.start, rows.start])
        spread = figure.rgb[nearest[0][rows, columns], nearest[1][rows, columns]]
        height, self.width = chart.shape[:2]
        self.scale = min(1.0, height / spread.shape[0], self.width / spread.shape[1])
        small = cv2.resize(spread, None, fx=self.scale, fy=self.scale, interpolation=cv2.INTER_AREA)
        own = [piece.colours.rgb for piece in pieces if piece.colours is not None]
        self.texture, self.starts = _side_by_side([chart, np.asarray(small, np.uint8), *own])
        self.own = [id(rgb) for rgb in own]

    def of_chart(self, uv: NDArray[np.floating]) -> NDArray[np.float64]:
        """Where the chart's points (S, 2) are in the texture."""
        return np.asarray(uv * [self.width / self.texture.shape[1], 1])

    def of_piece(self, piece: Piece) -> NDArray[np.float64]:
        """Where the colours of a piece's vertices (N, 2) are in the texture."""
        height, width = self.texture.shape[:2]
        if (colours := piece.colours) is not None:
            rows, columns = colours.rgb.shape[:2]
            places = 0.5 + colours.places * [columns - 1, rows - 1]
            start = np.array([self.starts[2 + self.own.index(id(colours.rgb))], 0])
            return np.asarray((places + start) / [width, height])
        pixels = piece.vertices[:, :2] @ self.to_picture[:, :2].T + self.to_picture[:, 2]
        places = (pixels - self.first + 0.5) * self.scale + [self.width, 0]
        end = self.starts[2] if len(self.starts) > 2 else width
        return np.asarray(np.clip(places, [self.width + 1, 0], [end - 1, height]) / [width, height])


def _side_by_side(pictures: Sequence[NDArray[np.uint8]]) -> tuple[NDArray[np.uint8], list[int]]:
    """Pictures in one, as high as the first, and the column at which each begins."""
    starts = [0, *np.cumsum([one.shape[1] for one in pictures]).tolist()]
    whole = np.zeros((pictures[0].shape[0], starts[-1], 3), np.uint8)
    for one, start in zip(pictures, starts, strict=False):
        whole[: one.shape[0], start : start + one.shape[1]] = one
    return whole, starts[:-1]
