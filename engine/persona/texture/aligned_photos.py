"""All photographs in one frame, each by its own mesh: what section 5 calls frontalised, with the dense mesh in place of a generic
face and 49 points."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.perception.face.head_pose import mirror_vertices
from engine.perception.face.landmarks import FACE_OVAL
from engine.persona.texture.texture_frame import TextureFrame, sampled

MIRRORED_WEIGHT = 0.5
"""Of a pixel whose colours come from the other side of the same face, since its own is turned away."""


@dataclass(frozen=True)
class AlignedPhotos:
    """N photographs in a frame (H, W).

    colours : (N, H, W, 3) uint8 sRGB.
    shown : (N, H, W) float32 in [0, 1], how well each pixel is shown; zero beside the face.
    """

    colours: NDArray[np.uint8]
    shown: NDArray[np.float32]

    def __len__(self) -> int:
        return len(self.colours)

    def grey(self) -> NDArray[np.float32]:
        """(N, H, W) in [0, 255]."""
        return np.asarray(self.colours @ LUMINANCE_WEIGHTS, np.float32)


def align_photos(
    frame: TextureFrame,
    meshes: Sequence[NDArray[np.floating]],
    photo: Callable[[int], NDArray[np.uint8]],
    tick: Callable[[float], None] = lambda fraction: None,
) -> AlignedPhotos:
    """The faces of `meshes` (478, 3), each of what `photo` gives for its number, (h, w, 3) uint8.

    What a turned head hides is taken from the mirrored side, and counts less.
    """
    height, width = frame.size
    colours = np.empty((len(meshes), height, width, 3), np.uint8)
    shown = np.empty((len(meshes), height, width), np.float32)
    opposite = _opposite(frame)
    for number, mesh in enumerate(meshes):
        rgb, lookup = photo(number), frame.lookup(mesh)
        own = sampled(rgb, lookup)
        visible = frame.facing(frame.rotation_of(mesh)) * frame.covered * _within(lookup, rgb.shape)
        other, seen_there = (
            cv2.remap(layer, opposite[..., 0], opposite[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
            for layer in (own, visible)
        )
        share = visible / np.maximum(visible + (1 - visible) * seen_there, 1e-3)
        mixed = own * share[..., None] + np.asarray(other) * (1 - share[..., None])
        colours[number] = np.clip(np.rint(mixed), 0, 255)
        shown[number] = np.maximum(visible, MIRRORED_WEIGHT * np.asarray(seen_there)) * frame.covered
        tick((number + 1) / len(meshes))
    return AlignedPhotos(colours, shown)


def _opposite(frame: TextureFrame) -> NDArray[np.float32]:
    """(H, W, 2) where the mirror image of each pixel is in the frame."""
    mirror = mirror_vertices().astype(int)
    place = {vertex: k for k, vertex in enumerate(FACE_OVAL)}
    rim = 478 + np.array([place[mirror[vertex]] for vertex in FACE_OVAL])
    return frame.interpolated(frame.places[np.concatenate([mirror, rim]), :2])


def _within(lookup: NDArray[np.float32], shape: tuple[int, ...]) -> NDArray[np.float32]:
    """(H, W) one where a photograph of `shape` (h, w, 3) reaches, zero beyond its edge."""
    inside = (lookup >= 0) & (lookup <= np.array(shape[1::-1]) - 1)
    return np.asarray(inside.all(axis=-1), np.float32)
