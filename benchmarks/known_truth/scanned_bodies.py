"""The scanned and modelled people of the test media, as `Person`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray
from trimesh.visual.material import PBRMaterial

from benchmarks.known_truth.known_person import Person
from engine.render.rasterisation.attributes import interpolate, sample_texture
from engine.render.rasterisation.rasteriser import Raster

BODY_HEIGHT_METRES = 1.8
"""Height to which scans are scaled."""


def read_scan(path: Path, facing: float) -> Person:
    """An OBJ or GLB of one person; `facing`: 1 where they look along +z, -1 where along -z. They become 1.8 m high."""
    scene: Any = trimesh.load_scene(path, process=False)
    vertices, triangles, uv, textures, ends = [], [], [], [], []
    count = 0
    for node in scene.graph.nodes_geometry:
        place, name = scene.graph[node]
        part = scene.geometry[name]
        vertices.append(trimesh.transform_points(part.vertices, place))
        triangles.append(np.asarray(part.faces) + count)
        uv.append(np.asarray(part.visual.uv, float) * [1, -1] + [0, 1])  # counted from the top, as in glTF
        textures.append(_texture(part.visual.material))
        ends.append(sum(map(len, triangles)))
        count += len(part.vertices)
    points = np.concatenate(vertices) * [facing, 1, facing]
    scale = BODY_HEIGHT_METRES / np.ptp(points[:, 1])
    middle = (points.min(0) + points.max(0)) / 2
    points = (points - [middle[0], points[:, 1].min(), middle[2]]) * scale
    faces = np.concatenate(triangles).astype(np.int32)
    return Person(
        path.stem, points, faces, BODY_HEIGHT_METRES, texture_painter(np.concatenate(uv), faces, textures, ends)
    )


def _texture(material: object) -> NDArray[np.uint8]:
    image = material.baseColorTexture if isinstance(material, PBRMaterial) else material.image  # type: ignore[attr-defined]
    return np.asarray(image.convert("RGB"), np.uint8)


def texture_painter(
    uv: NDArray[np.floating], faces: NDArray[np.int32], textures: list[NDArray[np.uint8]], ends: list[int]
) -> Callable[[Raster], NDArray[np.float32]]:
    """Colours from several textures, of which each covers the triangles before its end."""

    def paint(raster: Raster) -> NDArray[np.float32]:
        places = interpolate(uv, faces, raster)
        places = places - np.floor(places)  # textures repeat
        part = np.searchsorted(ends, raster.triangle, side="right")
        colours = np.zeros((*raster.triangle.shape, 3), np.float32)
        for k, texture in enumerate(textures):
            here = (part == k) & (raster.triangle >= 0)
            if here.any():
                colours += sample_texture(texture, places, here)
        return colours

    return paint
