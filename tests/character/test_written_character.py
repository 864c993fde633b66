"""What the benchmark of characters reads back and draws."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation
from template_character import template_character

from benchmarks.known_truth.written_character import outline, read_written
from engine.export.gltf.glb import CharacterModel, write_glb
from engine.geometry.rigging.skinning import skin
from engine.motion.clip import Clip
from engine.motion.kinematics import pose_transforms

SQUARE = np.array([[0, 1, 2], [0, 2, 3]])


def test_a_written_character_is_read_back_and_posed(tmp_path: Path) -> None:
    mesh = template_character(texture_size=64)
    turns = np.zeros((1, len(mesh.skeleton.names), 4), np.float32)
    turns[..., 3] = 1
    for name, turn in (("LeftArm", [0.2, 0.1, -1.0]), ("Spine1", [0.1, 0.6, 0.0]), ("RightLeg", [0.7, 0.0, 0.0])):
        turns[0, mesh.skeleton.index(name)] = Rotation.from_rotvec(turn).as_quat()
    pictured = Clip("pictured", 30.0, turns, mesh.skeleton.heads[:1] + np.float32(0.3))
    write_glb(tmp_path / "character.glb", CharacterModel(mesh, [pictured]))
    written = read_written(tmp_path / "character.glb")
    np.testing.assert_array_equal(written.mesh.vertices, mesh.vertices)
    np.testing.assert_array_equal(written.mesh.triangles, mesh.triangles)
    np.testing.assert_allclose(written.mesh.uv, mesh.uv, atol=1e-6)
    np.testing.assert_allclose(written.mesh.skeleton.heads, mesh.skeleton.heads, atol=1e-5)
    np.testing.assert_array_equal(written.mesh.skeleton.parents, mesh.skeleton.parents)
    assert written.mesh.texture.shape == mesh.texture.shape
    assert written.unbound < 1e-5
    assert written.unweighted < 1e-6
    transforms = pose_transforms(mesh.skeleton, pictured.rotations, pictured.root)[0]
    posed = skin(mesh.vertices, mesh.bones, mesh.weights, transforms)
    np.testing.assert_allclose(written.pictured, posed, atol=3e-3)  # weights are written in 255 steps


def test_an_outline_covers_the_pixels_that_are_covered_by_half() -> None:
    """From 2 to 9.6 along x, 3.4 to 6.6 along y, counted from the corners of pixels: two corners have 0.36 of theirs."""
    corners = np.array([[2, 3.4], [9.6, 3.4], [9.6, 6.6], [2, 6.6]]) - 0.5
    expected = np.zeros((12, 14), bool)
    expected[3:7, 2:10] = True
    expected[[3, 6], 9] = False
    np.testing.assert_array_equal(outline(corners, SQUARE, (12, 14)), expected)
    np.testing.assert_array_equal(outline(corners, SQUARE[:, ::-1], (12, 14)), expected)
