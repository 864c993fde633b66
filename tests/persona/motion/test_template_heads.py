"""Movements carried between two heads of the template whose eyes are known to be of different height: lids meet, and lips meet."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.body import load_template
from engine.body.body_space import load_body_space
from engine.body.shape import Phenotype, load_shape_space
from engine.perception.face.landmarks import LEFT_EYE, LIPS_INNER, RIGHT_EYE
from engine.persona.motion.deformation_transfer import DeformationTransfer
from engine.persona.motion.mesh_units import MeshUnits, mesh_units
from engine.persona.motion.performance import FRAME_SIZE
from engine.persona.texture.texture_frame import texture_frame

PHENOTYPE = Phenotype(0.6, 0.5, 0.5, 0.5, 0.5, 0.5, 1 / 3, 1 / 3, 1 / 3)


def head(direction: str) -> MeshUnits:
    """Somebody whose eyes are lower (`decr`) or higher (`incr`) than others', and the mouth narrower or wider."""
    eyes = {f"{side}-eye-height{k}-{direction}": 0.35 for side in "lr" for k in (1, 2, 3)}
    changes = {**eyes, f"mouth-scale-horiz-{direction}": 0.6}
    shaped = load_shape_space().shape(PHENOTYPE, changes)
    return mesh_units(load_template(), replace(load_body_space(), mean=shaped))


@pytest.fixture(scope="module")
def heads() -> tuple[MeshUnits, MeshUnits]:
    return head("decr"), head("incr")


def gaps(face: np.ndarray, contour: tuple[int, ...]) -> np.ndarray:
    half = len(contour) // 2
    return np.asarray(face[list(contour[:half:-1]), 1] - face[list(contour[1:half]), 1])


def unit(one: MeshUnits, name: str) -> np.ndarray:
    return np.asarray(one.moved[one.names.index(name)])


@pytest.mark.parametrize("back", [False, True])
def test_a_blink_shuts_eyes_of_another_height(heads: tuple[MeshUnits, MeshUnits], back: bool) -> None:
    driver, puppet = heads[::-1] if back else heads
    tall = [gaps(one.rest, RIGHT_EYE).mean() for one in heads]
    assert tall[1] > 1.2 * tall[0], "known to be higher"
    blink = unit(driver, "eyeBlinkLeft") + unit(driver, "eyeBlinkRight")
    transfer = DeformationTransfer(texture_frame(driver.rest, FRAME_SIZE), texture_frame(puppet.rest, FRAME_SIZE))
    for contour in (LEFT_EYE, RIGHT_EYE):
        plain, adjusted = (np.abs(gaps(puppet.rest + moved, contour)).mean() for moved in (blink, transfer(blink)))
        assert plain > 0.3 * gaps(puppet.rest, contour).mean(), "as it is, the movement does not fit"
        assert adjusted < 0.01 * gaps(puppet.rest, contour).mean(), "lids that are apart, or over each other"
        half = gaps(puppet.rest + transfer(blink / 2), contour).mean() / gaps(puppet.rest, contour).mean()
        assert half == pytest.approx(0.5, abs=0.03), "an eye that is half shut is so on both"


def test_lips_meet_from_a_mouth_that_is_open_wider(heads: tuple[MeshUnits, MeshUnits]) -> None:
    driver, puppet = (one.rest + share * unit(one, "jawOpen") for one, share in zip(heads, (0.2, 0.35), strict=True))
    close = -0.2 * unit(heads[0], "jawOpen")
    transfer = DeformationTransfer(texture_frame(driver, FRAME_SIZE), texture_frame(puppet, FRAME_SIZE))
    plain, adjusted = (np.abs(gaps(puppet + moved, LIPS_INNER)).mean() for moved in (close, transfer(close)))
    assert plain > 0.5 * gaps(puppet, LIPS_INNER).mean(), "as it is, the movement does not fit"
    left = gaps(driver + close, LIPS_INNER).mean() / gaps(driver, LIPS_INNER).mean()
    assert adjusted / gaps(puppet, LIPS_INNER).mean() < left + 0.05 < 0.2, "between shut lips the mesh leaves a little"


def test_shut_lips_stay_shut_where_they_smile(heads: tuple[MeshUnits, MeshUnits]) -> None:
    driver, puppet = heads
    smile = unit(driver, "mouthSmileLeft") + unit(driver, "mouthSmileRight")
    smile[list(LIPS_INNER)] = smile[list(LIPS_INNER)] + smile[list(LIPS_INNER[:1] + LIPS_INNER[:0:-1])]
    smile[list(LIPS_INNER)] /= 2  # lips that face each other go the same way
    transfer = DeformationTransfer(texture_frame(driver.rest, FRAME_SIZE), texture_frame(puppet.rest, FRAME_SIZE))
    before, after = (gaps(puppet.rest + moved, LIPS_INNER) for moved in (np.zeros_like(smile), transfer(smile)))
    np.testing.assert_allclose(after, before, atol=1e-3)
    assert np.abs(transfer(smile)[list(LIPS_INNER)]).max() > 0.05, "eye distances: and they do smile"
