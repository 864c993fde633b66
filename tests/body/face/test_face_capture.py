"""Face capture: what a face made of face units does is found again, wherever the head is."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.body.body_space import load_body_space
from engine.body.face.face_capture import (
    CAPTURED_UNITS,
    GAZE_UNITS,
    SUBTLE_UNITS,
    FaceUnitModel,
    capture_face_units,
    face_unit_model,
)
from engine.body.face.face_mesh_points import LOWER_LIP_VERTICES, UPPER_LIP_VERTICES, face_mesh_points
from engine.body.template import Template, load_template
from engine.perception.face.head_pose import canonical_face

EYE_DISTANCE = 100.0
REST = canonical_face().astype(np.float64) * EYE_DISTANCE + 300


@pytest.fixture(scope="module")
def template() -> Template:
    return load_template()


@pytest.fixture(scope="module")
def model(template: Template) -> FaceUnitModel:
    return face_unit_model(template, load_body_space())


def acting(model: FaceUnitModel, **weights: float) -> NDArray[np.float64]:
    """The canonical face (478, 3) with face units at these weights, pixels."""
    mesh = REST.copy()
    for unit, weight in weights.items():
        mesh[model.mesh] += weight * EYE_DISTANCE * model.units[CAPTURED_UNITS.index(unit)]
    return mesh


def held(mesh: NDArray[np.float64]) -> NDArray[np.float64]:
    """A face that is still for three frames."""
    return np.repeat(mesh[None], 3, axis=0)


def test_the_lower_lip_goes_with_the_jaw_and_the_upper_one_does_not(template: Template) -> None:
    points = face_mesh_points(template, load_body_space())
    jaw = np.linalg.norm(template.face_units.displacement({"jawOpen": 1.0}), axis=1)[points.template]
    assert jaw[np.isin(points.mesh, LOWER_LIP_VERTICES)].min() > jaw[np.isin(points.mesh, UPPER_LIP_VERTICES)].max()


def test_each_broad_unit_alone_is_found_as_the_strongest(model: FaceUnitModel) -> None:
    for unit in CAPTURED_UNITS:
        if unit in (*GAZE_UNITS, *SUBTLE_UNITS, "mouthClose"):  # told by irises; or give way; or only on an open jaw
            continue
        found = capture_face_units(model, held(acting(model, **{unit: 0.8})), REST)[1]
        assert CAPTURED_UNITS[int(found.argmax())] == unit
        assert 0.6 < found.max() <= 1, unit


def test_a_mixture_is_found_from_any_side_and_distance(model: FaceUnitModel) -> None:
    weights = {"jawOpen": 0.5, "mouthSmileLeft": 0.6, "mouthSmileRight": 0.6, "eyeBlinkLeft": 0.9, "browInnerUp": 0.7}
    turn = Rotation.from_euler("xyz", [0.1, 0.3, -0.2]).as_matrix()
    moved = (acting(model, **weights) - 300) @ turn.T * 1.7 + 500
    found = dict(zip(CAPTURED_UNITS, capture_face_units(model, held(moved), REST)[1], strict=True))
    for unit, weight in weights.items():
        assert found.pop(unit) == pytest.approx(weight, abs=0.1), unit
    others = [weight for unit, weight in found.items() if unit not in GAZE_UNITS]
    assert max(others) < 0.2


def test_a_face_at_rest_does_nothing_although_its_points_tremble(model: FaceUnitModel) -> None:
    noise = np.random.default_rng(5).normal(0, 0.3, (20, *REST.shape))
    found = capture_face_units(model, REST + noise, REST)
    assert found.max() < 0.25
    assert np.median(found.max(axis=0)) < 0.05


def test_an_iris_that_moves_towards_the_nose_is_a_look_inwards(model: FaceUnitModel) -> None:
    mesh = REST.copy()
    corner, inner = mesh[33], mesh[133]
    mesh[468:473, :2] += 0.1 * (inner - corner)[:2]  # half of the travel of a whole look: 0.2 eye widths
    found = dict(zip(CAPTURED_UNITS, capture_face_units(model, held(mesh), REST)[1], strict=True))
    assert found["eyeLookInRight"] == pytest.approx(0.5, abs=0.02)
    assert found["eyeLookOutRight"] == 0
    assert found["eyeLookInLeft"] == found["eyeLookOutLeft"] == 0


@pytest.mark.parametrize(("down", "unit"), [(1, "eyeLookDown"), (-1, "eyeLookUp")])
def test_irises_that_move_down_or_up_are_such_a_look_of_both_eyes(model: FaceUnitModel, down: int, unit: str) -> None:
    mesh = REST.copy()
    for irises, outer, inner in ((slice(468, 473), 33, 133), (slice(473, 478), 263, 362)):
        mesh[irises, 1] += 0.06 * down * abs(mesh[outer, 0] - mesh[inner, 0])
    found = dict(zip(CAPTURED_UNITS, capture_face_units(model, held(mesh), REST)[1], strict=True))
    looks = {name for name in GAZE_UNITS if found[name] > 0.1}
    assert looks == {f"{unit}Left", f"{unit}Right"}


def test_nothing_is_told_of_an_iris_under_a_shut_lid(model: FaceUnitModel) -> None:
    shut = acting(model, eyeBlinkRight=1.0)
    shut[468:473, :2] += 0.1 * (shut[133] - shut[33])[:2]
    found = dict(zip(CAPTURED_UNITS, capture_face_units(model, held(shut), REST)[1], strict=True))
    assert found["eyeBlinkRight"] == 1
    assert all(found[name] == 0 for name in GAZE_UNITS if name.endswith("Right"))
