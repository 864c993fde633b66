"""A ratio counts where both frames show skin: glasses, hair and blur leave no mark, a crease does."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from made_face import SKIN, in_crop, painted, placed
from numpy.typing import NDArray

from engine.face_animation.creases.fine_details import flatness
from engine.face_animation.creases.skin_in_both import SkinInBoth
from engine.perception.face_track.face_crop import CROP_SHAPE

FACE = in_crop(placed(70))[:, :2]
ORIGIN = np.stack(np.meshgrid(np.arange(CROP_SHAPE[1]), np.arange(CROP_SHAPE[0])), axis=-1).astype(np.float32)
FOREHEAD = tuple(int(x) for x in FACE[151].round())
CHEEK = tuple(int(x) for x in FACE[205].round())


@pytest.fixture(scope="module")
def face() -> NDArray[np.uint8]:
    """With pores, so that it has something that a blur takes."""
    grain = np.random.default_rng(1).normal(0, 6, (*CROP_SHAPE, 1))
    return np.clip(painted(FACE, CROP_SHAPE[::-1]) + grain, 0, 255).astype(np.uint8)


def share(neutral: NDArray, acted: NDArray, place: tuple[int, int]) -> float:
    found = SkinInBoth(neutral, FACE[:468]).share(acted, ORIGIN)
    return float(found[place[1] - 2 : place[1] + 3, place[0] - 2 : place[0] + 3].mean())


def lined(face: NDArray, place: tuple[int, int], colour: tuple[float, ...], width: int = 3) -> NDArray[np.uint8]:
    out = face.copy()
    cv2.line(out, (place[0] - 14, place[1]), (place[0] + 14, place[1]), colour, width)
    return out


def test_skin_that_creases_is_skin(face: NDArray) -> None:
    crease = lined(face, CHEEK, tuple(0.78 * one for one in SKIN))
    assert share(face, face, CHEEK) > 0.95
    assert share(face, crease, CHEEK) > 0.9


@pytest.mark.parametrize("colour", [(30, 25, 25), (120, 80, 40), (90, 110, 170), (60, 40, 25)])
def test_a_rim_or_a_lock_of_hair_that_comes_over_skin_is_not(face: NDArray, colour: tuple[int, ...]) -> None:
    assert share(face, lined(face, CHEEK, colour, 6), CHEEK) < 0.1


@pytest.mark.parametrize("colour", [(30, 25, 25), (90, 110, 170), (255, 255, 255)])
def test_nor_is_what_was_over_it_at_rest(face: NDArray, colour: tuple[int, ...]) -> None:
    """A rim, its blue coating, or a glare on it, that then moves off."""
    assert share(lined(face, FOREHEAD, colour, 6), face, FOREHEAD) < 0.1


def test_a_frame_that_is_blurred_tells_of_no_creases(face: NDArray) -> None:
    assert share(face, np.asarray(cv2.GaussianBlur(face, (0, 0), 5)), CHEEK) < 0.1


def test_shade_over_half_the_face_is_left_to_others(face: NDArray) -> None:
    """Light that changes widely is no reason to believe that skin is none."""
    shade = np.linspace(0.65, 1, CROP_SHAPE[1])[None, :, None]
    assert share(face, (face * shade).astype(np.uint8), CHEEK) > 0.7


def test_flat_colour_is_told_from_skin(face: NDArray) -> None:
    everywhere = np.ones(CROP_SHAPE, np.float32)
    assert flatness(face, everywhere, 96.0) < 0.05
    assert flatness(np.full_like(face, SKIN), everywhere, 96.0) == 1


def test_behind_spectacles_there_are_no_creases_and_below_them_there_are(face: NDArray) -> None:
    """Rims as light as the skin are told by their bridge alone."""
    worn = face.copy()
    x, y = (int(one) for one in FACE[6].round())
    for shade, rows in ((0.7, slice(y - 5, y - 1)), (1.15, slice(y - 1, y + 2)), (0.7, slice(y + 2, y + 6))):
        worn[rows, x - 16 : x + 17] = np.clip(shade * np.array(SKIN), 0, 255)
    under, lip = (tuple(int(one) for one in FACE[vertex].round()) for vertex in (118, 165))
    assert share(face, face, under) > 0.9
    assert share(worn, worn, under) < 0.1
    assert share(worn, worn, lip) > 0.9
