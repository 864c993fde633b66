"""What the figures of mouths and eyes are made of."""

from __future__ import annotations

import numpy as np
from made_face import LIP, SKIN, opened, painted, placed

from benchmarks.portrait_figures.mouths_and_eyes import between_lips, change, out_of_palette, palette_of, white_shares

SIZE = (320, 340)


def test_the_palette_is_of_skin_and_lips() -> None:
    face = placed(90, (160, 120))
    np.testing.assert_allclose(palette_of(painted(face, SIZE), face), [SKIN, LIP], atol=6)


def test_violet_and_green_are_out_of_it_and_teeth_and_tongue_are_not() -> None:
    palette = np.array([SKIN, LIP], float)
    colours = np.array([(225, 215, 200), (150, 85, 80), (40, 18, 18), (120, 90, 130), (90, 130, 90)], float)
    assert [out_of_palette(one[None], palette) for one in colours] == [0, 0, 0, 1, 1]


def test_a_mouth_that_only_moves_does_not_change() -> None:
    wide = opened(placed(90, (160, 120)), 0.4)
    there = opened(placed(90, (170, 128)), 0.4)
    mouths = [between_lips(painted(face, SIZE), face) for face in (wide, there)]
    assert change([*mouths, None, mouths[0]]) < 0.02
    assert change([mouths[0], 2 * mouths[0]]) > 0.9


def test_white_eyes_are_white_and_dark_ones_are_not() -> None:
    face = placed(120, (160, 160))
    rgb = painted(face, SIZE)
    assert min(white_shares(rgb, face, 170.0)) > 0.9
    assert max(white_shares((rgb * 0.3).astype(np.uint8), face, 170.0)) < 0.1
