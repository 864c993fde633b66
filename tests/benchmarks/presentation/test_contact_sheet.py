"""Sheets to look at: every picture is where it belongs, whole."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.presentation.contact_sheet import (
    GAP_PIXELS,
    SHEET_GREY_LEVEL,
    TITLE_PIXELS,
    Row,
    at_height,
    contact_sheet,
    evenly,
    fitted,
    write_sheet,
)
from engine.media.image import read_image

RED, GREEN, BLUE = (200, 0, 0), (0, 200, 0), (0, 0, 200)


def plain(height: int, width: int, colour: tuple[int, int, int]) -> np.ndarray:
    return np.full((height, width, 3), colour, np.uint8)


def test_pictures_stand_side_by_side_and_rows_one_under_the_other() -> None:
    above = Row([plain(10, 20, RED), plain(6, 30, GREEN)])
    sheet = contact_sheet([above, Row([plain(8, 12, BLUE)])], gap=3)
    assert sheet.shape == (10 + 3 + 8, 20 + 3 + 30, 3)
    expected = np.full_like(sheet, SHEET_GREY_LEVEL)
    expected[:10, :20], expected[:6, 23:], expected[13:, :12] = RED, GREEN, BLUE
    np.testing.assert_array_equal(sheet, expected)


def test_a_title_is_written_above_its_row_and_on_none_of_its_pictures() -> None:
    rows = [Row([plain(40, 60, RED), plain(40, 60, RED)], "first"), Row([plain(40, 60, BLUE)])]
    sheet = contact_sheet(rows)
    assert sheet.shape == (TITLE_PIXELS + 40 + GAP_PIXELS + 40, 60 + GAP_PIXELS + 60, 3)
    line = sheet[:TITLE_PIXELS]
    assert (line < 100).any() and (line == SHEET_GREY_LEVEL).mean() > 0.5
    np.testing.assert_array_equal(sheet[TITLE_PIXELS:], contact_sheet([Row(row.pictures) for row in rows]))


def test_a_picture_is_whole_in_the_middle_of_its_cell() -> None:
    cell = fitted(plain(40, 10, RED), (20, 30))
    expected = np.full((20, 30, 3), SHEET_GREY_LEVEL, np.uint8)
    expected[:, 12:17] = RED
    np.testing.assert_array_equal(cell, expected)
    sheet = contact_sheet([Row([plain(40, 10, RED), plain(7, 99, BLUE)])], cell=(20, 30), gap=0)
    assert sheet.shape == (20, 60, 3)
    np.testing.assert_array_equal(sheet[:, :30], cell)
    assert at_height(plain(40, 10, RED), 20).shape == (20, 5, 3)


def test_a_sheet_that_is_too_wide_is_made_smaller_in_its_proportions() -> None:
    row = Row([plain(50, 100, RED)])
    assert contact_sheet([row], max_width=40).shape == (20, 40, 3)
    assert contact_sheet([row], max_width=100).shape == (50, 100, 3)


def test_pictures_at_even_steps_begin_with_the_first_and_end_with_the_last() -> None:
    pictures = [plain(1, 1, (k, 0, 0)) for k in range(15)]
    assert [int(one[0, 0, 0]) for one in evenly(pictures, 8)] == [0, 2, 4, 6, 8, 10, 12, 14]
    assert [int(one[0, 0, 0]) for one in evenly(pictures[:3], 8)] == [0, 1, 2]


def test_what_is_written_is_what_is_shown(tmp_path: Path) -> None:
    sheet = contact_sheet([Row([plain(30, 40, GREEN)], "a row")], cell=(32, 32))
    path = tmp_path / "sheets" / "one.png"
    write_sheet(path, sheet)
    np.testing.assert_array_equal(read_image(path).rgb, sheet)
