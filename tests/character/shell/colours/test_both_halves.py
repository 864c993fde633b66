"""Both halves of a turned head, of painted heads of which all is known."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.character.shell.colours.both_halves import BothHalves, both_halves
from engine.character.shell.colours.head_map import head_map
from engine.character.shell.colours.unrolled import UNROLLED_COLUMNS

ANGLES = (np.arange(UNROLLED_COLUMNS) + 0.5) / UNROLLED_COLUMNS * 2 * np.pi - np.pi


def face() -> NDArray[np.float32]:
    """Both halves alike, smooth but for eyes and a mouth (A, `UNROLLED_COLUMNS`, 3)."""
    head = head_map()
    skin = 150 + 30 * np.cos(2 * head.angle) + 10 * np.sin(head.height / 9)
    eyes = (np.abs(head.height - head.levels["eyes"]) < 4) & (np.abs(head.angle - 0.33) < 0.12)
    mouth = (np.abs(head.height - 48) < 2) & (head.angle < 0.25)
    grey = np.where(eyes | mouth, 40, skin)
    return np.repeat(grey[..., None], 3, 2).astype(np.float32)


def seen(colours: NDArray[np.float32], turn: float) -> BothHalves:
    """What is made of a head seen from `turn` radians aside."""
    facing = np.broadcast_to(np.cos(ANGLES - turn), colours.shape[:2]).astype(np.float32)
    known = facing > 0.35
    return both_halves(head_map(), np.where(known[..., None], colours, 0), known, facing)


@pytest.mark.parametrize("turn", [-0.9, -0.6, 0.6, 0.9])
def test_the_far_half_is_the_near_one_mirrored(turn: float) -> None:
    found, head = seen(face(), turn), head_map()
    whole = np.broadcast_to(head.between("chin", "hairline") & (head.angle < 0.9), found.known.shape)
    assert found.known[whole].all()
    assert np.abs(found.colours - face())[whole].max() < 4


@pytest.mark.parametrize("turn", [-0.8, 0.8])
def test_it_is_in_its_own_light(turn: float) -> None:
    lit = face() * (1 + 0.2 * np.tanh(ANGLES / 0.1) * np.sign(turn)).astype(np.float32)[None, :, None]
    found, head = seen(lit, turn), head_map()
    far = (
        (np.sign(ANGLES) != np.sign(turn)) & head.between("nose", "hairline") & (head.angle > 0.5) & (head.angle < 0.8)
    )
    mirrored = lit[:, ::-1]
    assert np.abs(found.colours - lit)[far].mean() < 0.5 * np.abs(mirrored - lit)[far].mean()


def test_a_half_in_the_shade_has_no_image_of_what_is_lit() -> None:
    """A fifth as light: that its mirror image can be made as dark as that makes it no good one."""
    shaded = face() * np.where(ANGLES < 0, 0.2, 1).astype(np.float32)[None, :, None]
    found = seen(shaded, 0.5)
    there = np.broadcast_to(np.cos(ANGLES - 0.5) > 0.35, found.own.shape)
    assert (found.own == 1)[there].all()
    assert (found.colours == shaded)[there].all()


def test_of_a_face_from_the_front_nothing_changes() -> None:
    found = seen(face(), 0.0)
    assert (found.own == 1).all()
    assert (found.colours[found.known] == face()[found.known]).all()


def test_an_eye_is_its_own_or_the_others_whole() -> None:
    head = head_map()
    eye = (np.abs(head.height - head.levels["eyes"]) < 5) & (head.angle > 0.2) & (head.angle < 0.46)
    for turn in np.linspace(0.1, 1.0, 10):
        own = seen(face(), float(turn)).own[eye & (ANGLES < 0)]
        assert own.min() > 0.9 or own.max() < 0.1


def test_what_is_behind_the_far_cheek_is_not_on_it() -> None:
    head = head_map()
    wall = (ANGLES < -0.3) & head.between("chin", "hairline")
    found = seen(np.where(wall[..., None], np.float32([20, 200, 20]), face()), 0.7)
    cheek = np.broadcast_to((ANGLES < -0.45) & (ANGLES > -0.8) & head.between("chin", "nose"), wall.shape)
    assert np.abs(found.colours - face())[cheek].mean() < 12
    assert found.own[cheek].mean() < 0.1
