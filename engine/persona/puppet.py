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

from engine.geometry.subdivision import midpoint_subdivision
from engine.perception.face_tessellation import face_triangles, opening_triangles
from engine.persona.persona import Persona
from engine.render.attributes import interpolate, sample_texture
from engine.render.rasteriser import rasterise

ROUNDS = 2
"""Of the subdivision: triangles of a frame 194 wide are three pixels wide then."""
SUPERSAMPLING = 2
FACE_VERTICES = 468
"""Of the mesh's: those after them are the irises'."""


@dataclass(frozen=True)
class Puppet:
    """A person's face that can be posed."""

    persona: Persona

    def draw(
        self,
        face: NDArray[np.floating],
        texture: NDArray[np.uint8],
        placing: tuple[NDArray[np.floating], NDArray[np.floating]],
        picture: NDArray[np.uint8],
    ) -> NDArray[np.uint8]:
        """The face drawn over a `picture` (h, w, 3).

        face : (478, 3) its vertices from the front, in eye distances. texture : (H, W, 3) of the persona's frame. placing : a matrix
        (3, 3), rotation times pixels for an eye distance, and a shift (3,): where vertices are in the picture.
        """
        matrix, triangles = self._surface
        finer = matrix @ np.asarray(face, np.float64)[:FACE_VERTICES]
        finer[:, 2] += self._relief
        linear, shift = placing
        places = finer @ np.asarray(linear, np.float64).T + shift
        places[:, :2] = places[:, :2] * SUPERSAMPLING + (SUPERSAMPLING - 1) / 2
        size = picture.shape[0] * SUPERSAMPLING, picture.shape[1] * SUPERSAMPLING
        raster = rasterise(places, triangles, size, cull=True)
        covered = raster.triangle >= 0
        colours = sample_texture(texture, interpolate(self._uv, triangles, raster), covered)
        share = cv2.resize(covered.astype(np.float32), picture.shape[1::-1], interpolation=cv2.INTER_AREA)[..., None]
        drawn = cv2.resize(colours, picture.shape[1::-1], interpolation=cv2.INTER_AREA)
        return np.asarray(np.clip(np.rint(drawn + (1 - share) * picture), 0, 255), np.uint8)

    @cached_property
    def _surface(self) -> tuple[sp.csr_array, NDArray[np.int32]]:
        coarse = np.concatenate([face_triangles(), opening_triangles()])
        matrix, triangles = midpoint_subdivision(coarse, FACE_VERTICES, ROUNDS)
        return matrix, np.ascontiguousarray(triangles[:, ::-1])  # counter-clockwise, which is what is not culled

    @cached_property
    def _at(self) -> NDArray[np.float64]:
        """(M, 3) where the finer vertices are in the persona's frame, pixels."""
        return np.asarray(self._surface[0] @ self.persona.frame.places[:FACE_VERTICES])

    @cached_property
    def _uv(self) -> NDArray[np.float64]:
        return (self._at[:, :2] + 0.5) / np.array(self.persona.frame.size[::-1])

    @cached_property
    def _relief(self) -> NDArray[np.float64]:
        """(M,) eye distances by which the average shape is beneath the mesh."""
        at = self._at.astype(np.float32)
        depth = cv2.remap(self.persona.depth, at[:, :1], at[:, 1:2], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        off = (np.asarray(depth)[:, 0] - self._at[:, 2]) / self.persona.frame.scale
        return np.asarray(off, np.float64)
