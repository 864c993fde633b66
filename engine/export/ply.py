"""Point clouds and plain meshes as PLY, binary and little-endian, as MeshLab, Blender and CloudCompare read them.

Source: G. Turk, The PLY Polygon File Format, Stanford University, 1994.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.geometry.point_clouds.point_cloud import PointCloud

VERTEX_RECORD = np.dtype([("xyz", "<f4", 3), ("normal", "<f4", 3), ("rgb", "u1", 3)])
PLY_HEADER = """ply
format binary_little_endian 1.0
element vertex {count}
property float x
property float y
property float z
property float nx
property float ny
property float nz
property uchar red
property uchar green
property uchar blue
end_header
"""

TRIANGLE_RECORD = np.dtype([("count", "u1"), ("corners", "<i4", 3)])
MESH_HEADER = """ply
format binary_little_endian 1.0
element vertex {vertices}
property float x
property float y
property float z
element face {triangles}
property list uchar int vertex_indices
end_header
"""


def write_ply(path: Path, cloud: PointCloud) -> None:
    """Write a cloud: 27 bytes a point."""
    rows = np.empty(len(cloud), VERTEX_RECORD)
    rows["xyz"], rows["normal"], rows["rgb"] = cloud.points, cloud.normals, cloud.colours
    with path.open("wb") as file:
        file.write(PLY_HEADER.format(count=len(cloud)).encode())
        file.write(rows.tobytes())


def write_mesh_ply(path: Path, vertices: NDArray[np.floating], triangles: NDArray[np.integer]) -> None:
    """Write a mesh, its vertices (V, 3) and triangles (T, 3), without colours: 12 and 13 bytes each."""
    corners = np.empty(len(triangles), TRIANGLE_RECORD)
    corners["count"], corners["corners"] = 3, triangles
    with path.open("wb") as file:
        file.write(MESH_HEADER.format(vertices=len(vertices), triangles=len(triangles)).encode())
        file.write(np.ascontiguousarray(vertices, "<f4").tobytes())
        file.write(corners.tobytes())
