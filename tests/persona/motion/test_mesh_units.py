"""ARKit's units at the vertices of the tracked mesh, by what faces do."""

from __future__ import annotations

import numpy as np
import pytest

from engine.body import load_template
from engine.body.body_space import load_body_space
from engine.perception.face.face_tessellation import face_triangles
from engine.perception.face.head_pose import canonical_face, mirror_vertices
from engine.perception.face.landmarks import FACE_OVAL, LEFT_EYE, LIPS_INNER, RIGHT_EYE, eye_distance
from engine.persona.motion.mesh_units import MeshUnits, mesh_units

FACE_VERTICES = 468


@pytest.fixture(scope="module")
def units() -> MeshUnits:
    return mesh_units(load_template(), load_body_space())


def doing(units: MeshUnits, *names: str) -> np.ndarray:
    return units.rest + sum(units.moved[units.names.index(name)] for name in names)


def test_the_template_is_a_face_as_the_tracker_has_them(units: MeshUnits) -> None:
    assert eye_distance(units.rest) == pytest.approx(1, abs=1e-4)
    apart = np.linalg.norm(units.rest - canonical_face(), axis=1)[:FACE_VERTICES]
    assert np.median(apart) < 0.1 and apart.max() < 0.45, "eye distances"
    corners = units.rest[face_triangles(), :2]
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    clockwise = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0] > 0
    assert clockwise.mean() > 0.99, "from before hardly a triangle is seen from behind"


def test_both_sides_are_alike(units: MeshUnits) -> None:
    mirror, across = mirror_vertices().astype(int), np.array([-1, 1, 1])
    left, right = (units.moved[units.names.index(f"mouthSmile{side}")] for side in ("Left", "Right"))
    np.testing.assert_allclose(right, left[mirror] * across, atol=1e-9)
    corner = 291
    assert left[corner, 1] < -0.05 < left[61, 1], "the left corner goes up, the right one hardly"


@pytest.mark.parametrize(("side", "contour"), [("Left", LEFT_EYE), ("Right", RIGHT_EYE)])
def test_lids_meet_in_a_blink(units: MeshUnits, side: str, contour: tuple[int, ...]) -> None:
    upper, lower = list(contour[1:8]), list(contour[:8:-1])
    gap = (units.rest[lower] - units.rest[upper])[:, 1]
    assert gap.max() > 0.1 and gap.min() > 0
    shut = doing(units, f"eyeBlink{side}")
    np.testing.assert_allclose(shut[upper], shut[lower], atol=1e-9)
    other = {"Left": RIGHT_EYE, "Right": LEFT_EYE}[side]
    assert np.abs(shut - units.rest)[list(other)].max() < 0.01


def test_the_jaw_takes_the_lower_lip_and_the_chin_and_lips_can_close_over_it(units: MeshUnits) -> None:
    upper, lower = list(LIPS_INNER[1:10]), list(LIPS_INNER[:10:-1])
    assert np.abs((units.rest[lower] - units.rest[upper])[:, 1]).max() < 0.02
    opened = doing(units, "jawOpen")
    assert (opened[lower] - opened[upper])[4, 1] > 0.4
    assert (opened - units.rest)[152, 1] > 0.3 and np.abs((opened - units.rest)[FACE_OVAL[0]]).max() < 0.01
    closed = doing(units, "jawOpen", "mouthClose")
    assert np.abs((closed[lower] - closed[upper])[:, 1]).max() < 0.1
