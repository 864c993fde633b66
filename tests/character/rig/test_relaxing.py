"""What moves a surface is spread where it would stretch, and nowhere else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse
from scipy.spatial.transform import Rotation
from template_character import template_character

from benchmarks.character_figures.stretching import stretched
from engine.character.rig.measures import pose
from engine.character.rig.relaxing import SurfaceGraph, relaxed, stiffened_weights
from engine.character.rig.rigging import Character, at_rest
from engine.geometry.mesh.welding import is_closed, weld
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import skin
from engine.motion.clip import Clip
from engine.motion.kinematics import pose_transforms


def arms_down(mesh: SkinnedMesh) -> Clip:
    turns = np.zeros((1, len(mesh.skeleton.names), 4), np.float32)
    turns[..., 3] = 1
    for name, degrees in (("LeftArm", -70), ("RightArm", 70)):
        turns[0, mesh.skeleton.index(name)] = Rotation.from_euler("z", degrees, degrees=True).as_quat()
    return Clip("pictured", 30.0, turns, mesh.skeleton.heads[:1].copy())


@pytest.fixture(scope="module")
def torn() -> Character:
    """A body each of whose vertices goes with one joint alone, as bound in a picture with its arms down."""
    mesh = template_character(texture_size=64)
    pictured = arms_down(mesh)
    transforms = pose_transforms(mesh.skeleton, pictured.rotations, pictured.root)[0]
    shown = skin(mesh.vertices, mesh.bones, mesh.weights, transforms).astype(np.float64)
    alone = np.zeros_like(mesh.weights)
    alone[:, 0] = 1
    vertices, weights, _ = at_rest(shown, mesh.bones.astype(np.intp), alone, transforms)
    return Character(replace(mesh, vertices=vertices.astype(np.float32), weights=weights), pictured, np.zeros(3))


def test_edges_that_tore_stretch_no_more(torn: Character) -> None:
    eased = relaxed(torn)
    for name in ("dance", "jump", "run"):
        assert stretched(torn, name) > 0.003
        assert stretched(eased, name) < 0.25 * stretched(torn, name)


def test_the_pictured_pose_and_the_surface_are_what_they_were(torn: Character) -> None:
    eased = relaxed(torn)
    np.testing.assert_allclose(pose(eased, eased.pictured), pose(torn, torn.pictured), atol=1e-5)
    np.testing.assert_array_equal(eased.mesh.triangles, torn.mesh.triangles)
    np.testing.assert_allclose(eased.mesh.weights.sum(1), 1, atol=1e-5)
    assert eased.mesh.vertices[:, 1].min() == pytest.approx(0, abs=1e-6)
    assert is_closed(weld(eased.mesh)[eased.mesh.triangles]) == is_closed(weld(torn.mesh)[torn.mesh.triangles])


def test_what_stretches_nowhere_stays_as_it_is() -> None:
    mesh = template_character(texture_size=64)
    one = replace(
        mesh, bones=np.zeros_like(mesh.bones), weights=np.eye(1, 4, dtype=np.float32).repeat(len(mesh.bones), 0)
    )
    stiff = Character(one, arms_down(mesh), np.zeros(3))
    eased = relaxed(stiff)
    np.testing.assert_array_equal(eased.mesh.weights, one.weights)
    np.testing.assert_allclose(eased.mesh.vertices, one.vertices, atol=1e-6)


def test_two_points_meet_as_far_as_the_edge_between_them_is_stiff() -> None:
    """The least of (p - 1)^2 + (q - 0)^2 + s (p - q)^2 has p - q = 1 / (1 + 2 s) and p + q = 1."""
    edges = np.array([[0, 1], [2, 3]])
    half = sparse.csr_matrix((np.ones(2), edges.T), (4, 4))
    surface = SurfaceGraph(np.zeros((4, 3)), edges, np.ones(2), half + half.T)
    before = np.array([[1.0, 0], [0, 1], [1, 0], [0, 1]])
    after = stiffened_weights(surface, before, np.array([2.0, 0, 0, 0]))
    np.testing.assert_allclose(after[0], [0.6, 0.4], atol=1e-12)
    np.testing.assert_allclose(after[1], [0.4, 0.6], atol=1e-12)
    np.testing.assert_array_equal(after[2:], before[2:])
