"""What is behind the puppet covers all of it, in its own proportions."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from engine.errors import InputError
from engine.media.image import write_image
from engine.media.limits import Limits
from engine.persona.backdrop import backdrop

GREY = (58, 60, 64)


def test_without_a_picture_it_is_the_colour() -> None:
    assert (backdrop(GREY, (30, 20), None, Limits()) == GREY).all()


def test_a_wide_picture_loses_its_sides_alone(tmp_path: Path) -> None:
    wide = np.zeros((40, 120, 3), np.uint8)
    wide[:, 40:80] = (200, 40, 40)
    write_image(tmp_path / "wide.png", wide)
    plate = backdrop(GREY, (80, 80), tmp_path / "wide.png", Limits())
    assert plate.shape == (80, 80, 3) and np.abs(plate[:, 4:-4].astype(int) - (200, 40, 40)).max() <= 2


def test_a_tall_picture_loses_top_and_bottom_alone(tmp_path: Path) -> None:
    tall = np.zeros((120, 40, 3), np.uint8)
    tall[40:80] = (200, 40, 40)
    write_image(tmp_path / "tall.png", tall)
    plate = backdrop(GREY, (80, 80), tmp_path / "tall.png", Limits())
    assert plate.shape == (80, 80, 3) and np.abs(plate[4:-4].astype(int) - (200, 40, 40)).max() <= 2


def test_what_a_picture_lets_through_is_the_colour(tmp_path: Path) -> None:
    alpha = np.ones((50, 50), np.float32)
    alpha[:, :25] = 0
    write_image(tmp_path / "cut.png", np.full((50, 50, 3), 250, np.uint8), alpha)
    plate = backdrop(GREY, (50, 50), tmp_path / "cut.png", Limits())
    assert (plate[:, :20] == GREY).all() and (plate[:, 30:] >= 248).all()


def test_what_is_no_picture_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.png").write_bytes(b"nothing")
    with pytest.raises(InputError):
        backdrop(GREY, (50, 50), tmp_path / "a.png", Limits())
