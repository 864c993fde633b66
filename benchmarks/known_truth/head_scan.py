"""A scanned head seen from any side: the truth that turned portraits are held against."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray

from engine.geometry.camera import Camera
from engine.geometry.mesh.surface import vertex_normals
from engine.media.image import read_image
from engine.render.lighting.film import box_downsample
from engine.render.rasterisation.attributes import interpolate, sample_texture
from engine.render.rasterisation.rasteriser import rasterise

SCAN_SUPERSAMPLING = 3
CAMERA_DISTANCE_SCAN_HEIGHTS = 8.0
"""Heights of the scan from the camera to the head: a portrait lens."""
SCAN_LIGHT_DIRECTION = np.array([0.25, 0.45, 0.85])
"""Where the light comes from; it stays where it is when the head turns."""
SCAN_AMBIENT_SHARE = 0.55
"""Share of the light that comes from everywhere."""
BACKGROUND_RGB = (150, 160, 170)
AIM_SCAN_HEIGHTS = 0.17
"""Heights of the scan above its middle at which the camera looks."""
NECK_SCAN_HEIGHTS = (-0.28, -0.08)
"""Heights of the scan above its middle between which the neck twists: the shoulders below do not turn."""

HIDDEN_DEPTH_SCAN_HEIGHTS = 0.01
"""Heights of the scan by which a vertex lies behind what is seen, to be hidden."""


@dataclass(frozen=True)
class HeadScan:
    """vertices : (V, 3), y up, facing +z, centred.
    triangles : (T, 3).
    uv : (V, 2).
    texture : (h, w, 3) uint8.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    uv: NDArray[np.float64]
    texture: NDArray[np.uint8]


def read_head_scan(folder: Path) -> HeadScan:
    """The scan in `folder`: `head.obj` and `color.jpg`."""
    mesh: Any = trimesh.load_mesh(folder / "head.obj", process=False)
    vertices = np.asarray(mesh.vertices, float)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    uv = np.asarray(mesh.visual.uv, float) * [1, -1] + [0, 1]  # OBJ counts from the bottom, glTF from the top
    return HeadScan(vertices - (low + high) / 2, np.asarray(mesh.faces), uv, read_image(folder / "color.jpg").rgb)


def render_head(
    scan: HeadScan,
    yaw: float,
    size: tuple[int, int],
    background: NDArray[np.uint8] | None = None,
    zoom: float = 1.0,
    shoulders: bool = False,
) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """The head turned by `yaw` degrees (> 0: the face to the picture's right), with a shadowless lamp.

    `size` (width, height). `background` (height, width, 3), one colour if None. `shoulders` turns them too.
    Returns the picture (height, width, 3) uint8 and the head's coverage (height, width) float32.
    """
    height = float(np.ptp(scan.vertices[:, 1]))
    vertices = _turned(scan.vertices, np.deg2rad(yaw), height, shoulders) - (0, AIM_SCAN_HEIGHTS * height, 0)
    camera = _camera(height, size, zoom).scaled(SCAN_SUPERSAMPLING)
    raster = rasterise(camera.project(vertices), scan.triangles, camera.size, perspective=True)
    covered = raster.triangle >= 0
    colours = sample_texture(scan.texture, interpolate(scan.uv, scan.triangles, raster), covered)
    normals = interpolate(vertex_normals(vertices, scan.triangles), scan.triangles, raster)
    lamp = np.clip(normals @ (SCAN_LIGHT_DIRECTION / np.linalg.norm(SCAN_LIGHT_DIRECTION)).astype(np.float32), 0, 1)
    shaded = colours * (SCAN_AMBIENT_SHARE + (1 - SCAN_AMBIENT_SHARE) * lamp[..., None])
    alpha = box_downsample(covered.astype(np.float32)[..., None], SCAN_SUPERSAMPLING)[..., 0]
    premultiplied = box_downsample(np.asarray(np.where(covered[..., None], shaded, 0), np.float32), SCAN_SUPERSAMPLING)
    behind = np.asarray(BACKGROUND_RGB if background is None else background, np.float32)
    picture = premultiplied + (1 - alpha[..., None]) * behind
    return np.clip(picture + 0.5, 0, 255).astype(np.uint8), np.asarray(alpha, np.float32)


def project_scan(
    scan: HeadScan, yaw: float, size: tuple[int, int], zoom: float = 1.0
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Where the scan's vertices are in the picture that `render_head` draws, (V, 2) pixels, and how well each is seen,
    (V,). That is the cosine between its surface and the line of sight, and 0 where something is before it."""
    height = float(np.ptp(scan.vertices[:, 1]))
    vertices = _turned(scan.vertices, np.deg2rad(yaw), height, False) - (0, AIM_SCAN_HEIGHTS * height, 0)
    camera = _camera(height, size, zoom)
    places = camera.project(vertices)
    raster = rasterise(places, scan.triangles, camera.size, perspective=True)
    x, y = np.clip(np.rint(places[:, :2]), 0, np.array(size) - 1).astype(int).T
    hidden = places[:, 2] > raster.depth[y, x] + HIDDEN_DEPTH_SCAN_HEIGHTS * height
    towards = np.array(camera.eye) - vertices
    cosine = (vertex_normals(vertices, scan.triangles) * towards).sum(axis=1) / np.linalg.norm(towards, axis=1)
    return places[:, :2].astype(float), np.where(hidden, 0.0, cosine).astype(float)


def _camera(height: float, size: tuple[int, int], zoom: float) -> Camera:
    width_px, height_px = size
    return Camera(
        eye=(0.0, 0.0, CAMERA_DISTANCE_SCAN_HEIGHTS * height),
        focal=zoom * 0.8 * height_px * CAMERA_DISTANCE_SCAN_HEIGHTS,
        centre=((width_px - 1) / 2, (height_px - 1) / 2),
        size=(height_px, width_px),
    )


def _turned(vertices: NDArray[np.float64], yaw: float, height: float, shoulders: bool) -> NDArray[np.float64]:
    t = np.clip((vertices[:, 1] / height - NECK_SCAN_HEIGHTS[0]) / (NECK_SCAN_HEIGHTS[1] - NECK_SCAN_HEIGHTS[0]), 0, 1)
    angle = yaw * (np.ones_like(t) if shoulders else t * t * (3 - 2 * t))
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = vertices.T
    return np.stack([c * x + s * z, y, c * z - s * x], axis=1)
