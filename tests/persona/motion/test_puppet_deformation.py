"""Movements carried to a face whose eyes and mouth are larger: lids meet, lips meet."""

from __future__ import annotations

import numpy as np
import pytest

from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import LEFT_EYE, LIPS_INNER, LIPS_OUTER, RIGHT_EYE
from engine.persona.motion.deformation_transfer import DeformationTransfer
from engine.persona.texture.texture_frame import texture_frame

SIZE = (244, 194)


def stretched(mesh: np.ndarray, contours: tuple[tuple[int, ...], ...], factor: float, reach: float) -> np.ndarray:
    """A face whose features are `factor` times as high: all around within `reach` moves along, less and less."""
    out = mesh.copy()
    for contour in contours:
        middle = mesh[list(contour), :2].mean(axis=0)
        wide = np.ptp(mesh[list(contour), 0]) / 2
        off = mesh[:, :2] - middle
        near = np.exp(
            -(np.maximum(np.abs(off[:, 0]) / wide - 1, 0) ** 2) * 4
            - np.maximum(np.abs(off[:, 1]) - reach / 3, 0) ** 2 / (reach / 2) ** 2
        )
        out[:, 1] += (factor - 1) * off[:, 1] * near * (np.abs(off[:, 1]) < reach)
    return out


def gaps(mesh: np.ndarray, contour: tuple[int, ...]) -> np.ndarray:
    """How far the upper side of a contour is above the lower, where it is not its corners."""
    half = len(contour) // 2
    upper, lower = np.array(contour[2 : half - 1]), np.array(contour[:half:-1][1 : half - 2])
    return mesh[lower, 1] - mesh[upper, 1]


def closed(mesh: np.ndarray, contour: tuple[int, ...]) -> np.ndarray:
    """(478, 3) what moves the upper side of a contour, and what is above it, onto the lower."""
    half = len(contour) // 2
    moved = np.zeros_like(mesh)
    for k in range(1, half):
        upper, lower = contour[k], contour[-k]
        moved[upper, 1] = mesh[lower, 1] - mesh[upper, 1]
    return moved


@pytest.mark.parametrize("factor", [0.65, 1.6])
def test_lids_meet_on_eyes_of_another_height(factor: float) -> None:
    driver = np.asarray(canonical_face(), np.float64)
    puppet = stretched(driver, (RIGHT_EYE, LEFT_EYE), factor, 0.3)
    before = gaps(puppet, RIGHT_EYE)
    assert before.mean() == pytest.approx(factor * gaps(driver, RIGHT_EYE).mean(), rel=0.1)
    blink = closed(driver, RIGHT_EYE) + closed(driver, LEFT_EYE)
    assert np.abs(gaps(driver + blink, RIGHT_EYE)).max() < 1e-6
    transfer = DeformationTransfer(texture_frame(driver, SIZE), texture_frame(puppet, SIZE))
    plain, adjusted = gaps(puppet + blink, RIGHT_EYE), gaps(puppet + transfer(blink), RIGHT_EYE)
    assert np.abs(plain).mean() > 0.3 * before.mean(), "as it is, the movement does not fit"
    assert np.abs(adjusted).mean() < 0.25 * np.abs(plain).mean()


def test_lips_meet_on_a_larger_mouth() -> None:
    neutral = np.asarray(canonical_face(), np.float64)
    half = len(LIPS_INNER) // 2
    opened = neutral.copy()
    for k in range(1, half):
        opened[LIPS_INNER[-k], 1] += 0.25
    for k in range(1, len(LIPS_OUTER) // 2):
        opened[LIPS_OUTER[-k], 1] += 0.25
    puppet = stretched(opened, (LIPS_INNER,), 1.5, 0.5)
    close = closed(opened, LIPS_INNER)
    transfer = DeformationTransfer(texture_frame(opened, SIZE), texture_frame(puppet, SIZE))
    plain, adjusted = gaps(puppet + close, LIPS_INNER), gaps(puppet + transfer(close), LIPS_INNER)
    assert np.abs(adjusted).mean() < 0.5 * np.abs(plain).mean()


def test_between_faces_that_are_alike_nothing_is_changed() -> None:
    face = np.asarray(canonical_face(), np.float64)
    frame = texture_frame(face, SIZE)
    smile = closed(face, RIGHT_EYE) * 0.5
    np.testing.assert_allclose(DeformationTransfer(frame, frame)(smile), smile, atol=2e-3)


def test_rest_is_rest() -> None:
    face = np.asarray(canonical_face(), np.float64)
    transfer = DeformationTransfer(
        texture_frame(face, SIZE), texture_frame(stretched(face, (RIGHT_EYE,), 1.5, 0.3), SIZE)
    )
    assert np.abs(transfer(np.zeros((478, 3)))).max() == 0
