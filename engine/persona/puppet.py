"""The puppet: the person's shape, textured by an expression, as a head that turns shows it.

It is drawn on the face's own triangles, split into smaller ones that carry the relief of the average shape: a depth map's own rim is
jagged from the side.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from engine.face_animation.mouth.mouth_interior import MouthInterior
from engine.geometry.mesh.adjacency import edge_table
from engine.geometry.mesh.subdivision import midpoint_subdivision
from engine.perception.face.face_tessellation import face_triangles, opening_triangles
from engine.perception.face.landmarks import FACE_OVAL
from engine.persona.mouth.persona_mouth import puppet_mouth
from engine.persona.persona import Persona
from engine.render.scene.scratch import Scratch
from engine.render.scene.surface import Surface, draw_surface, triangle_spread
from engine.render.textures.mipmap import build_mipmap

FRAME_SUBDIVISIONS = 2
"""Of the subdivision: triangles of a frame 194 wide are three pixels wide then."""
PUPPET_CAMERA_DISTANCE_PIXELS = 4096.0
"""Pixels from the eye to the face: so far off that nearer parts are no larger."""
FACE_VERTICES = 468
"""Of the mesh's: those after them are the irises'."""


@dataclass(frozen=True)
class Puppet:
    """A person's face that can be posed; its skin goes on over its eyes and mouth, or has `openings` there."""

    persona: Persona
    openings: bool = False

    def draw(
        self,
        face: NDArray[np.floating],
        texture: NDArray[np.uint8],
        placing: tuple[NDArray[np.floating], NDArray[np.floating]],
        picture: NDArray[np.uint8],
    ) -> NDArray[np.uint8]:
        """The face drawn over a `picture` (h, w, 3).

        face : (478, 3) its vertices from the front, in eye distances.
        texture : (H, W, 3) of the persona's frame.
        placing : where vertices are in the picture: a matrix (3, 3), rotation times pixels for an eye distance, and a
            shift (3,).
        """
        linear, shift = placing
        points = self.vertices(face) @ np.asarray(linear, np.float64).T + shift
        points[:, 2] += PUPPET_CAMERA_DISTANCE_PIXELS - points[:, 2].mean()
        drawn = picture.copy()
        enlarged = np.cbrt(abs(np.linalg.det(linear))) / self.persona.frame.scale
        finest = min(texture.shape[:2])
        mipmap = build_mipmap(texture, max(16, int(finest * min(enlarged, 1) / 2) + 1))  # no smaller than it is shown
        surface = self.surface._replace(mipmap=mipmap)
        draw_surface(drawn, False, surface, points.astype(np.float32), Scratch())
        places = np.asarray(face, np.float64) @ np.asarray(linear, np.float64).T + shift
        self.mouth.draw(drawn, places[:, :2].astype(np.float32), 0)
        return drawn

    @cached_property
    def mouth(self) -> MouthInterior:
        """What is between its lips."""
        return puppet_mouth(self.persona).interior

    def vertices(self, face: NDArray[np.floating]) -> NDArray[np.float64]:
        """(M, 3) the vertices that are drawn of a `face` (478, 3), with the average shape's relief; in eye distances."""
        finer = self.finer(face)
        finer[:, 2] += self._relief
        return finer

    def finer(self, values: NDArray[np.floating]) -> NDArray[np.float64]:
        """(M, 3) what the face mesh's vertices have, (478, 3), at those that are drawn."""
        return np.asarray(self._subdivision[0] @ np.asarray(values, np.float64)[:FACE_VERTICES])

    @cached_property
    def surface(self) -> Surface:
        """The triangles that are drawn, and where their vertices are on the persona's frame."""
        triangles = self._subdivision[1]
        size = self.persona.frame.size
        uv = ((self._at[:, :2] + 0.5) / np.array(size[::-1])).astype(np.float32)
        edges = edge_table(triangles, np.arange(len(uv), dtype=np.int32))
        blank = build_mipmap(np.zeros((*size, 3), np.uint8))
        return Surface(triangles, uv, triangle_spread(triangles, uv, size), edges, True, blank)

    @cached_property
    def _subdivision(self) -> tuple[sp.csr_array, NDArray[np.int32]]:
        coarse = face_triangles() if self.openings else np.concatenate([face_triangles(), opening_triangles()])
        matrix, triangles = midpoint_subdivision(coarse, FACE_VERTICES, FRAME_SUBDIVISIONS, FACE_OVAL)
        return matrix, np.ascontiguousarray(triangles[:, ::-1])  # counter-clockwise, which is what is not culled

    @cached_property
    def _at(self) -> NDArray[np.float64]:
        """(M, 3) where the finer vertices are in the persona's frame, pixels."""
        return np.asarray(self._subdivision[0] @ self.persona.frame.places[:FACE_VERTICES])

    @cached_property
    def _relief(self) -> NDArray[np.float64]:
        """(M,) eye distances by which the average shape is beneath the mesh."""
        at = self._at.astype(np.float32)
        depth = cv2.remap(self.persona.depth, at[:, :1], at[:, 1:2], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        off = (np.asarray(depth)[:, 0] - self._at[:, 2]) / self.persona.frame.scale
        return np.asarray(off, np.float64)
