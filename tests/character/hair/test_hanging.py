"""Hair hangs from hair above it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.character.hair.hanging import hanging


def drawn(*rows: str) -> NDArray[np.str_]:
    return np.array([list(row) for row in rows])


def test_what_hangs_goes_down_and_aside_and_never_up() -> None:
    """`R` is a root, `h` hangs, `x` does not, `.` is nothing."""
    picture = drawn(
        "..RR...x.",
        "..hh...x.",
        ".h..hhhh.",
        ".h.....h.",
        "h.h..x..h",
    )
    found = picture != "."
    np.testing.assert_array_equal(hanging(found, picture == "R"), np.isin(picture, ["R", "h"]))


def test_it_passes_behind_ears() -> None:
    """`e` is before hair, and counts as none."""
    picture = drawn(
        "RR....",
        "hh....",
        ".e....",
        ".e..x.",
        ".hh.x.",
    )
    hair, roots, ears = np.isin(picture, ["R", "h", "x"]), picture == "R", picture == "e"
    np.testing.assert_array_equal(hanging(hair, roots, ears), np.isin(picture, ["R", "h"]))
    assert not hanging(hair, roots)[4].any()
