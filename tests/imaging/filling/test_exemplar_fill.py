"""Patches that grow into a hole from its edge."""

from __future__ import annotations

import numpy as np

from engine.imaging.filling.exemplar_fill import exemplar_fill
from engine.imaging.filling.patchmatch import valid_centres


def test_what_is_neither_a_hole_nor_known_has_no_say_and_stays() -> None:
    """A field of stripes with a hole, beside what is of another colour and is not to be copied from."""
    image = np.zeros((40, 60, 3), np.float32)
    image[::4] = 200
    image[:, 40:] = (255, 0, 0)
    hole, known = np.zeros((40, 60), np.bool_), np.zeros((40, 60), np.bool_)
    hole[10:30, 28:40] = True
    known[:, :40] = ~hole[:, :40]
    filled = exemplar_fill(image, hole, valid_centres(known), known)
    np.testing.assert_array_equal(filled[:, 40:], image[:, 40:])
    assert np.abs(filled[12:28, 30:38] - image[12:28, :1]).mean() < 20
    other = image.copy()
    other[:, 40:] = np.random.default_rng(0).integers(0, 256, (40, 20, 3))
    np.testing.assert_array_equal(exemplar_fill(other, hole, valid_centres(known), known)[hole], filled[hole])
