"""The turntable: one whole turn, the avatar always whole in the picture."""

import numpy as np
import pytest
from template_character import still, template_character

from engine.avatar.turntable import backdrop, orbit_camera, turntable
from engine.geometry.rigging.skinned_mesh import SkinnedMesh

SIZE = (72, 128)


@pytest.fixture(scope="module")
def mesh() -> SkinnedMesh:
    return template_character(texture_size=64)


def test_the_camera_goes_round_it_counter_clockwise_and_looks_at_its_middle(mesh: SkinnedMesh) -> None:
    middle = (mesh.vertices.min(0) + mesh.vertices.max(0))[None] / 2
    for angle in (0.0, 1.0, 2.0, 3.0):
        camera = orbit_camera(mesh.vertices, SIZE, angle)
        away = np.array(camera.eye) - middle[0]
        assert np.arctan2(away[0], away[2]) == pytest.approx(angle)
        assert camera.project(middle)[0, :2] == pytest.approx([35.5, 63.5], abs=1e-3)


def test_from_every_side_all_of_it_is_within_the_picture(mesh: SkinnedMesh) -> None:
    for angle in np.linspace(0, 2 * np.pi, 12):
        seen = orbit_camera(mesh.vertices, SIZE, angle).project(mesh.vertices)
        assert (seen[:, :2] >= 0).all()
        assert (seen[:, :2] <= np.array(SIZE) - 1).all()


def test_a_quarter_of_the_film_is_a_quarter_turn_and_the_film_closes(mesh: SkinnedMesh) -> None:
    frames = list(turntable(mesh, still(mesh.skeleton), SIZE, seconds=2.0, fps=4.0))
    assert len(frames) == 8
    covered = [(frame[:84] != backdrop(SIZE)[:84]).any(axis=2) for frame in frames]  # above the shadow
    front, side, back = covered[0], covered[2], covered[4]
    assert front.sum() > 1.3 * side.sum()  # people are wider than deep
    overlap = (front & back[:, ::-1]).sum() / (front | back[:, ::-1]).sum()
    assert overlap > 0.8  # from behind the outline is mirrored, but for perspective and a turned head
