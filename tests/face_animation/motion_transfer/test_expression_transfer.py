"""Expressions carried to a face of other proportions: linear maps that differ over the face."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import placed, smiling
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.alignment import align
from engine.face_animation.motion_transfer.expression_transfer import carry_expression, local_maps

UNIT = 60.0


@pytest.fixture(scope="module")
def neutral() -> NDArray[np.float32]:
    return placed(UNIT, (200, 200))


def maps(neutral: NDArray, target: NDArray) -> NDArray:
    return local_maps(align(neutral, target), neutral, target, UNIT)


@pytest.mark.parametrize(("scale", "roll"), [(1.0, 0.0), (2.0, 0.0), (0.5, 20.0)])
def test_between_faces_of_the_same_shape_it_is_equation_1(neutral: NDArray, scale: float, roll: float) -> None:
    target = placed(scale * UNIT, (400, 300), roll=roll)
    phi = align(neutral, target)
    found = local_maps(phi, neutral, target, UNIT)
    np.testing.assert_allclose(found, np.broadcast_to(phi.linear, found.shape), atol=1e-4)
    expression = (smiling(neutral) - neutral)[None]
    carried = carry_expression(found, phi, expression)
    np.testing.assert_allclose(carried[0, :, :2], phi.offsets(expression[0, :, :2]), atol=1e-3)
    np.testing.assert_allclose(carried[0, :, 2], phi.scale * expression[0, :, 2], atol=1e-3)


def test_a_wider_mouth_smiles_wider(neutral: NDArray) -> None:
    """The target's lower face is a third wider: sideways offsets there grow, upward ones hardly, the eyes' not."""
    target = neutral.copy()
    lower = np.clip((neutral[:, 1] - 200) / (0.8 * UNIT), 0, 1)
    target[:, 0] = 200 + (neutral[:, 0] - 200) * (1 + 0.33 * lower)
    found = maps(neutral, target)
    assert found[[61, 291], 0, 0].min() > 1.15
    assert np.abs(found[[61, 291], 1, 1] - 1).max() < 0.1
    assert np.abs(found[[33, 263, 105, 334]] - np.eye(2)).max() < 0.15


def test_maps_vary_smoothly_and_never_mirror(neutral: NDArray) -> None:
    rng = np.random.default_rng(0)
    target = neutral + rng.normal(0, 2, neutral.shape).astype(np.float32)
    found = maps(neutral, target)
    assert (np.linalg.det(found) > 0.5).all()
    near = np.linalg.norm(neutral[:, None, :2] - neutral[None, :, :2], axis=2) < 0.08 * UNIT
    apart = np.abs(found[:, None] - found[None]).max(axis=(2, 3))
    assert apart[near].max() < 0.15


def test_no_expression_is_no_offset(neutral: NDArray) -> None:
    target = placed(100, (50, 50), roll=-9)
    phi = align(neutral, target)
    carried = carry_expression(local_maps(phi, neutral, target, UNIT), phi, np.zeros((3, 478, 3)))
    assert carried.shape == (3, 478, 3) and not carried.any()
