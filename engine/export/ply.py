"""Point clouds as PLY, binary and little-endian, as MeshLab, Blender and CloudCompare read them.

Source: G. Turk, The PLY Polygon File Format, Stanford University, 1994.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from engine.geometry.point_cloud import PointCloud

VERTEX = np.dtype([("xyz", "<f4", 3), ("normal", "<f4", 3), ("rgb", "u1", 3)])
HEADER = """ply
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


def write_ply(path: Path, cloud: PointCloud) -> None:
    """Write a cloud: 27 bytes a point."""
    rows = np.empty(len(cloud), VERTEX)
    rows["xyz"], rows["normal"], rows["rgb"] = cloud.points, cloud.normals, cloud.colours
    with path.open("wb") as file:
        file.write(HEADER.format(count=len(cloud)).encode())
        file.write(rows.tobytes())
