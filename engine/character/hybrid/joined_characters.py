"""Two characters of one person in one mesh, with one texture."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.rig.rigging import Character
from engine.character.texture.texture import MAX_TEXTURE_WIDTH_PIXELS
from engine.geometry.rigging.skinned_mesh import SkinnedMesh

CROP_MARGIN_TEXELS = 8
"""Texels around what is used of a texture that are kept."""


def joined(first: Character, second: Character) -> Character:
    """Both, of the same joints but for how high these stand, as one: it stands and is seen as the `first`."""
    one, other = first.mesh, second.mesh
    lift = (one.skeleton.heads[0] - other.skeleton.heads[0]).astype(np.float32)
    (left, left_uv), (right, right_uv) = _cropped(one), _cropped(other)
    texture, places = _side_by_side((left, right), (left_uv, right_uv))
    mesh = SkinnedMesh(
        one.skeleton,
        np.concatenate([one.vertices, other.vertices + lift]),
        np.concatenate([one.triangles, other.triangles + len(one.vertices)]).astype(np.int32),
        places,
        np.concatenate([one.bones, other.bones]),
        np.concatenate([one.weights, other.weights]),
        texture,
    )
    return replace(first, mesh=mesh)


def _cropped(mesh: SkinnedMesh) -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    """What a mesh uses of its texture, and its places (V, 2) there, pixels."""
    height, width = mesh.texture.shape[:2]
    places = mesh.uv.astype(np.float64) * [width, height]
    first = np.maximum(np.floor(places.min(0)).astype(int) - CROP_MARGIN_TEXELS, 0)
    last = np.minimum(np.ceil(places.max(0)).astype(int) + CROP_MARGIN_TEXELS, [width, height])
    return mesh.texture[first[1] : last[1], first[0] : last[0]], places - first


def _side_by_side(
    pictures: tuple[NDArray[np.uint8], ...], places: tuple[NDArray[np.float64], ...]
) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """One texture of some, and the places (V, 2) of all in it, in [0, 1]."""
    scale = min(1.0, MAX_TEXTURE_WIDTH_PIXELS / sum(one.shape[1] for one in pictures))
    if scale < 1:
        pictures = tuple(
            np.asarray(cv2.resize(one, (int(one.shape[1] * scale), round(one.shape[0] * scale)), interpolation=cv2.INTER_AREA), np.uint8)
            for one in pictures
        )  # fmt: skip
    height, width = max(one.shape[0] for one in pictures), sum(one.shape[1] for one in pictures)
    texture = np.zeros((height, width, 3), np.uint8)
    at, found = 0, []
    for picture, own in zip(pictures, places, strict=True):
        texture[: picture.shape[0], at : at + picture.shape[1]] = picture
        found.append((own * scale + [at, 0]) / [width, height])
        at += picture.shape[1]
    return texture, np.concatenate(found).astype(np.float32)
