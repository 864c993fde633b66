"""Margins around a picture are told from backdrops in it."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from engine.imaging.picture_frame import SOFT_LINES, inner_picture
from engine.imaging.window import Window


def photograph(height: int = 120, width: int = 100) -> NDArray[np.uint8]:
    noise = np.random.default_rng(0).integers(0, 200, (height // 4, width // 4, 3), np.uint8)
    return np.asarray(cv2.resize(noise, (width, height), interpolation=cv2.INTER_NEAREST), np.uint8)


@pytest.mark.parametrize("sides", [(30, 0, 25, 0), (0, 4, 0, 4), (2, 0, 0, 0), (12, 10, 8, 30)])
@pytest.mark.parametrize("level", [255, 0, 230])
def test_margins_are_what_was_put_around(sides: tuple[int, int, int, int], level: int) -> None:
    left, top, right, bottom = sides
    framed = cv2.copyMakeBorder(photograph(), top, bottom, left, right, cv2.BORDER_CONSTANT, value=(level,) * 3)
    inner = inner_picture(framed)
    soft = [SOFT_LINES * (side > 0) for side in sides]
    assert (inner.left, inner.top) == (left + soft[0], top + soft[1])
    assert (inner.right, inner.bottom) == (left + 100 - soft[2], top + 120 - soft[3])


@pytest.mark.parametrize("sides", [(30, 0, 25, 0), (20, 17, 20, 17)])
def test_a_picture_that_was_sent_has_its_margins_still(sides: tuple[int, int, int, int]) -> None:
    left, top, right, bottom = sides
    framed = cv2.copyMakeBorder(photograph(), top, bottom, left, right, cv2.BORDER_CONSTANT, value=(255, 255, 255))
    as_sent = cv2.imdecode(cv2.imencode(".jpg", framed, [cv2.IMWRITE_JPEG_QUALITY, 95])[1], cv2.IMREAD_COLOR)
    found = inner_picture(np.asarray(as_sent, np.uint8))
    away = np.subtract((found.left, found.top, found.right, found.bottom), (left, top, left + 100, top + 120))
    assert np.abs(away).max() <= 4


def test_a_line_within_a_mat_is_part_of_the_frame() -> None:
    lined = cv2.copyMakeBorder(photograph(), 2, 2, 2, 2, cv2.BORDER_CONSTANT, value=(10, 10, 10))
    framed = cv2.copyMakeBorder(lined, 9, 9, 9, 9, cv2.BORDER_CONSTANT, value=(250, 250, 250))
    assert inner_picture(framed) == Window(13, 13, 109, 129)


def test_a_backdrop_is_no_margin() -> None:
    studio = np.full((120, 100, 3), 255, np.uint8)
    cv2.circle(studio, (50, 60), 30, (90, 60, 30), -1)
    assert inner_picture(studio) == Window(0, 0, 100, 120)
    fading = np.broadcast_to(np.linspace(255, 40, 120).astype(np.uint8)[:, None, None], (120, 100, 3)).copy()
    assert inner_picture(fading) == Window(0, 0, 100, 120)
    assert inner_picture(np.zeros((40, 40, 3), np.uint8)) == Window(0, 0, 40, 40)
    assert inner_picture(photograph()) == Window(0, 0, 100, 120)
