"""The frame in which all photographs are laid on one another: a face from the front, drawn by the mesh's own triangles.

It stands for the frontal view that section 5 brings photographs to: what is at a pixel of it is found in a photograph by the
photograph's own mesh.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.geometry.mesh.surface import vertex_normals
from engine.geometry.registration.rigid import fit_similarity
from engine.imaging.resample import resized
from engine.perception.face.face_tessellation import face_triangles, opening_triangles
from engine.perception.face.landmarks import FACE_OVAL, RIGID_VERTICES
from engine.render.rasterisation.attributes import interpolate
from engine.render.rasterisation.rasteriser import Raster, rasterise

RIM_SCALE = 1.22
"""Of the oval, about its middle: as far around the face hair and neck are shown."""
FRAME_MARGIN_PIXELS = 2.0
FACING_COSINES = (0.15, 0.45)
"""Of the angle to the camera between which what a photograph shows of the surface begins to count, and counts in full."""
_OVAL = np.array(FACE_OVAL)


@dataclass(frozen=True)
class TextureFrame:
    """A face of a mesh and its rim in a picture of (H, W).

    places : (V, 3) float64 vertices in pixels, z too, the mesh's 478 and the rim's after them.
    normals : (V, 3) of unit length, z away from the viewer.
    triangles : (T, 3).
    raster : which covers each pixel, and where.
    face : (H, W) bool, within the oval.
    scale : pixels for one unit of the mesh.
    """

    places: NDArray[np.float64]
    normals: NDArray[np.float64]
    triangles: NDArray[np.int32]
    raster: Raster
    face: NDArray[np.bool_]
    scale: float

    @property
    def size(self) -> tuple[int, int]:
        """(H, W)."""
        height, width = self.face.shape
        return height, width

    @property
    def covered(self) -> NDArray[np.bool_]:
        """(H, W) where the face or its rim is."""
        return self.raster.triangle >= 0

    def interpolated(self, values: NDArray[np.floating]) -> NDArray[np.float32]:
        """(H, W, C) values (V, C) of the vertices at every pixel; zero where nothing is."""
        return interpolate(values, self.triangles, self.raster)

    def lookup(self, mesh: NDArray[np.floating]) -> NDArray[np.float32]:
        """(H, W, 2) where in a photograph each pixel is, by the photograph's `mesh` (478, 2 or 3), pixels."""
        return self.interpolated(with_rim(mesh[:, :2]))

    def rotation_of(self, mesh: NDArray[np.floating]) -> NDArray[np.float64]:
        """(3, 3) by which the head of a photograph's `mesh` (478, 3) is turned from this frame's."""
        chosen = list(RIGID_VERTICES)
        return fit_similarity(self.places[chosen], np.asarray(mesh, np.float64)[chosen]).rotation

    def facing(self, rotation: NDArray[np.floating]) -> NDArray[np.float32]:
        """(H, W) in [0, 1], how well a photograph shows each pixel whose head is turned by `rotation` (3, 3) from this frame."""
        cosine = -(self.normals @ np.asarray(rotation, np.float64).T)[:, 2:]
        low, high = FACING_COSINES
        return np.clip((self.interpolated(cosine)[..., 0] - low) / (high - low), 0, 1)


def texture_frame(mesh: NDArray[np.floating], size: tuple[int, int]) -> TextureFrame:
    """A frame of `size` (height, width) for a frontal `mesh` (478, 3): x to the picture's right, y down, z away from the viewer."""
    whole = with_rim(np.asarray(mesh, np.float64))
    low, high = whole[:, :2].min(axis=0), whole[:, :2].max(axis=0)
    extent = np.array(size[::-1], np.float64)
    scale = float(((extent - 1 - 2 * FRAME_MARGIN_PIXELS) / (high - low)).min())
    places = whole * scale
    places[:, :2] += (extent - 1) / 2 - scale * (low + high) / 2
    triangles = np.concatenate([face_triangles(), opening_triangles(), _rim_triangles(len(mesh))])
    raster = rasterise(places, triangles, size)
    inner = len(triangles) - 2 * len(_OVAL)
    face = (raster.triangle >= 0) & (raster.triangle < inner)
    # clockwise in a picture whose y is down is counter-clockwise about an axis away from the viewer: normals look away from us
    normals = -np.asarray(vertex_normals(places, triangles), np.float64)
    return TextureFrame(places, normals, triangles, raster, face, scale)


def with_rim(mesh: NDArray[np.floating]) -> NDArray[np.float64]:
    """(478 + 36, D) the vertices of a mesh (478, D), and its oval drawn larger about the oval's middle."""
    oval = np.asarray(mesh, np.float64)[_OVAL]
    middle = oval.mean(axis=0)
    return np.concatenate([mesh, middle + RIM_SCALE * (oval - middle)])


def sampled(rgb: NDArray[np.uint8], lookup: NDArray[np.float32]) -> NDArray[np.float32]:
    """(H, W, 3) float32 in [0, 255], a photograph (h, w, 3) at the places `lookup` (H, W, 2); where it has more pixels than the frame,
    their means. Beyond its edge it is continued by its outermost pixels."""
    step = float(np.median(np.linalg.norm(np.diff(lookup, axis=1), axis=-1)))
    picture, places = rgb, lookup
    if step > 1.5:
        height, width = rgb.shape[:2]
        picture = resized(rgb, (max(round(width / step), 1), max(round(height / step), 1)))
        ratio = np.array(picture.shape[1::-1], np.float32) / (width, height)
        places = ((lookup + np.float32(0.5)) * ratio - np.float32(0.5)).astype(np.float32)
    at = (places[..., 0], places[..., 1])
    found = cv2.remap(picture.astype(np.float32), *at, cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
    return np.clip(np.asarray(found, np.float32), 0, 255)


def _rim_triangles(count: int) -> NDArray[np.int32]:
    inner, outer = _OVAL, count + np.arange(len(_OVAL))
    after = np.roll(np.arange(len(_OVAL)), -1)
    return np.concatenate(
        [np.stack([inner, outer, outer[after]], 1), np.stack([inner, outer[after], inner[after]], 1)]
    ).astype(np.int32)
