"""What is folded over in the picture's view is drawn smooth, and nothing else is touched."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from template_character import template_character

from engine.character.rig.measures import pose
from engine.character.rig.rigging import Character
from engine.character.rig.turned_over import backs_in_view, without_backs_in_view
from engine.geometry.camera import Camera
from engine.geometry.mesh.welding import weld
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.motion.clip import Clip

CAMERA = Camera((0.0, 1.0, 4.0), 700.0, (200.0, 300.0), (600, 400))


def standing(mesh: SkinnedMesh) -> Character:
    turns = np.zeros((1, len(mesh.skeleton.names), 4), np.float32)
    turns[..., 3] = 1
    return Character(mesh, Clip("pictured", 30.0, turns, mesh.skeleton.heads[:1].copy()), np.array([0.0, 1.0, 4.0]))


@pytest.fixture(scope="module")
def whole() -> Character:
    return standing(template_character(texture_size=64))


@pytest.fixture(scope="module")
def below(whole: Character) -> NDArray[np.intp]:
    """The vertices of one point of a forearm's lower side."""
    vertices, point = whole.mesh.vertices, weld(whole.mesh)
    height = np.where(np.abs(vertices[:, 0] - 0.5) < 0.02, vertices[:, 1], np.inf)
    return np.flatnonzero(point == point[height.argmin()])


def test_a_surface_without_folds_stays_as_it_is(whole: Character) -> None:
    assert not len(backs_in_view(whole, CAMERA))
    assert without_backs_in_view(whole, CAMERA) is whole


def test_a_point_that_comes_out_on_the_other_side_goes_back_between_its_neighbours(
    whole: Character, below: NDArray
) -> None:
    """Pulled up through a forearm, what is around it is seen above from within."""
    vertices = whole.mesh.vertices.copy()
    vertices[below] += np.array([0, 0.12, 0], np.float32)
    folded = replace(whole, mesh=replace(whole.mesh, vertices=vertices))
    assert len(backs_in_view(folded, CAMERA)) > 10
    mended = without_backs_in_view(folded, CAMERA)
    assert not len(backs_in_view(mended, CAMERA))
    apart = np.linalg.norm(pose(mended, mended.pictured) - pose(whole, whole.pictured), axis=1)
    assert apart.max() < 0.04
    assert np.count_nonzero(apart > 1e-6) < 60
    assert weld(mended.mesh).max() == weld(whole.mesh).max()
