"""Lower lids of drawn eyes that are larger than the mesh knows, and of eyes that are not."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import painted, placed, turn
from numpy.typing import NDArray

from engine.face_animation.eyes.lower_lids import fit_lower_lids
from engine.perception.face.landmarks import LEFT_EYE, RIGHT_EYE

SIZE = (500, 500)


def width(mesh: NDArray, eye: tuple[int, ...]) -> float:
    return float(np.linalg.norm(mesh[eye[8], :2] - mesh[eye[0], :2]))


def reaching_down(mesh: NDArray, by: float, *eyes: tuple[int, ...], roll: float = 0.0) -> NDArray[np.float32]:
    """The face with the lower lids of some eyes `by` eye widths lower."""
    lower = mesh.copy()
    for eye in eyes:
        lower[list(eye[9:]), :2] += by * width(mesh, eye) * turn(roll=roll)[:2, 1]
    return lower


@pytest.mark.parametrize("roll", [0, 20])
@pytest.mark.parametrize("by", [0.06, 0.1])
def test_lids_follow_eyes_that_are_drawn_larger(by: float, roll: float) -> None:
    mesh = placed(160, (250, 200), roll=roll)
    drawn = reaching_down(mesh, by, RIGHT_EYE, LEFT_EYE, roll=roll)
    fitted = fit_lower_lids(painted(drawn, SIZE), mesh)
    for eye in (RIGHT_EYE, LEFT_EYE):
        lower = list(eye[9:])
        off = np.linalg.norm(fitted[lower, :2] - drawn[lower, :2], axis=1)
        assert off.max() < 0.035 * width(mesh, eye) and off.mean() < 0.02 * width(mesh, eye)
        assert np.array_equal(fitted[list(eye[:9])], mesh[list(eye[:9])])
    moved = np.linalg.norm(fitted - mesh, axis=1)
    assert moved[152] == moved[1] == moved[10] == 0  # chin, nose and forehead stay
    assert moved[list(range(468, 478))].max() == 0


@pytest.mark.parametrize("eyes", [(), (RIGHT_EYE,), (LEFT_EYE,)])
def test_a_mesh_that_fits_stays_and_one_eye_alone_is_a_shadow(eyes: tuple[tuple[int, ...], ...]) -> None:
    mesh = placed(160, (250, 200))
    assert fit_lower_lids(painted(reaching_down(mesh, 0.08, *eyes), SIZE), mesh) is mesh


def test_small_and_shut_eyes_and_plain_pictures_are_no_harm() -> None:
    mesh = placed(160, (250, 200))
    plain = np.full((500, 500, 3), 128, np.uint8)
    assert fit_lower_lids(plain, mesh) is mesh
    flat = mesh.copy()
    for eye in (RIGHT_EYE, LEFT_EYE):
        flat[list(eye), 1] = flat[eye[0], 1]
    assert fit_lower_lids(plain, flat) is flat
    small = placed(20, (5, 5))
    assert fit_lower_lids(plain[:12, :12], small) is small
