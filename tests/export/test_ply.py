"""PLY files: another reader finds the points, normals and colours that were written."""

from pathlib import Path

import numpy as np
import trimesh

from engine.export.ply import write_mesh_ply, write_ply
from engine.geometry.point_clouds.point_cloud import PointCloud


def test_trimesh_reads_back_what_was_written(tmp_path: Path) -> None:
    random = np.random.default_rng(7)
    points = random.normal(size=(100, 3)).astype(np.float32)
    normals = points / np.linalg.norm(points, axis=1, keepdims=True)
    colours = random.integers(0, 256, (100, 3), dtype=np.uint8)
    write_ply(tmp_path / "points.ply", PointCloud(points, normals, colours))

    read = trimesh.load(tmp_path / "points.ply")
    assert np.array_equal(np.asarray(read.vertices, np.float32), points)
    assert np.array_equal(np.asarray(read.colors)[:, :3], colours)
    raw = read.metadata["_ply_raw"]["vertex"]["data"]
    assert np.array_equal(np.stack([raw["nx"], raw["ny"], raw["nz"]], axis=1).reshape(-1, 3), normals)


def test_trimesh_reads_a_mesh_back(tmp_path: Path) -> None:
    box = trimesh.creation.box((1.0, 2.0, 3.0))
    write_mesh_ply(tmp_path / "box.ply", box.vertices, box.faces)
    read = trimesh.load(tmp_path / "box.ply", process=False)
    assert np.array_equal(read.vertices, box.vertices) and np.array_equal(read.faces, box.faces)
    assert read.volume == 6 and (tmp_path / "box.ply").stat().st_size < 600
