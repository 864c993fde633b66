"""Collars below a face: told from skin and from hair that falls."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.character.hybrid.neck_cloth import neck_cloth

HEIGHT, WIDTH = 140, 120
FACE = np.array([60.0, 45.0, 18.0, 26.0, 0.0])
SKIN, HAIR, COAT, LINING = (215, 170, 145), (50, 34, 26), (40, 60, 110), (190, 30, 40)
Y, X = np.mgrid[:HEIGHT, :WIDTH]


def person(falls: bool) -> tuple[NDArray[np.uint8], NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_]]:
    """A picture with head and trunk as they are labelled, and the collar that stands up above their border: short hair, or hair that `falls`
    beside the face down to that."""
    oval = np.hypot((X - 60) / 18, (Y - 45) / 26) < 1
    skull = np.hypot((X - 60) / (24 if falls else 20), (Y - 40) / 32) < 1
    beside = (np.abs(X - 60) < 25) & (Y > 40) & (Y < 76) & falls
    neck = (np.abs(X - 60) < 10) & (Y > 60) & (Y < 84)
    collar = (np.abs(X - 60) < 24) & (np.abs(X - 60) > 8) & (Y > 66) & (Y < 82) & ~oval
    head = (skull | neck | collar | beside) & (Y < 80)
    trunk = (np.abs(X - 60) < 45) & (Y >= 80)
    rgb = np.full((HEIGHT, WIDTH, 3), 240.0)
    for where, colour in (
        (trunk, COAT), (skull | beside, HAIR), ((skull & (Y > 30) & ~beside) | oval | neck, SKIN), (collar, COAT)
    ):  # fmt: skip
        rgb[where] = colour
    noise = np.random.default_rng(0).normal(0, 4, rgb.shape)
    return np.clip(rgb + noise, 0, 255).astype(np.uint8), head, trunk, collar & head


@pytest.mark.parametrize("falls", [False, True], ids=["short hair", "hair to the collar"])
def test_a_collar_is_the_trunks(falls: bool) -> None:
    rgb, head, trunk, collar = person(falls)
    found = neck_cloth(rgb, head, trunk, FACE)
    assert (found & collar).sum() > 0.9 * (found | collar).sum()


def test_a_lining_of_another_colour_goes_with_the_coat() -> None:
    rgb, head, trunk, collar = person(False)
    inside = collar & (np.abs(X - 60) < 14)
    rgb[inside] = LINING
    found = neck_cloth(rgb, head, trunk, FACE)
    assert found[inside].mean() > 0.8


def test_nothing_is_told_where_hair_that_falls_has_the_coats_colour() -> None:
    rgb, head, trunk, _ = person(True)
    black = np.abs(rgb.astype(int) - HAIR).max(-1) < 30
    rgb[black] = np.clip(np.array(COAT) + np.random.default_rng(1).normal(0, 4, (int(black.sum()), 3)), 0, 255)
    assert not neck_cloth(rgb, head, trunk, FACE).any()


def test_a_bare_neck_stays_the_heads() -> None:
    rgb, head, trunk, collar = person(False)
    rgb[collar] = rgb[45, 60]
    assert neck_cloth(rgb, head, trunk, FACE).sum() < 0.02 * head.sum()
    assert not neck_cloth(rgb, head, trunk, None).any(), "no face, no mouth to be below"


@pytest.mark.parametrize("shade", [0.9, 0.7, 0.5, 0.4])
def test_a_neck_in_the_shade_above_a_low_neckline_stays_the_heads(shade: float) -> None:
    """Darker than the face, and going on below the head's label, where a dark vest has its neckline."""
    rgb, head, trunk, collar = person(False)
    bare = (head & (Y > 66)) | collar | (trunk & (np.abs(X - 60) < 20) & (Y < 100))
    rgb[bare] = rgb[bare] * 0 + (np.array(SKIN) * shade).astype(np.uint8)
    rgb[trunk & ~bare] = rgb[trunk & ~bare] // 3
    noise = np.random.default_rng(2).normal(0, 4, rgb.shape)
    found = neck_cloth(np.clip(rgb + noise, 0, 255).astype(np.uint8), head, trunk, FACE)
    assert found.sum() < 0.02 * head.sum()
