"""Healed seams: what no source shows disappears, what a source shows stays."""

from __future__ import annotations

import numpy as np
import pytest

from engine.imaging.filling.poisson import membrane
from engine.imaging.filling.seams import heal_seams

ROWS, COLUMNS = np.mgrid[:48, :64].astype(np.float32)
HOLE = np.zeros((48, 64), bool)
HOLE[12:36, 20:44] = True


def copied(picture: np.ndarray, field: np.ndarray) -> np.ndarray:
    return np.where(HOLE[..., None], picture[field[..., 0], field[..., 1]], picture)


def stay() -> np.ndarray:
    return np.stack(np.mgrid[:48, :64], axis=-1).astype(np.int32)


def test_a_picture_copied_from_its_own_place_is_unchanged() -> None:
    picture = np.random.default_rng(1).uniform(0, 255, (48, 64, 3)).astype(np.float32)
    np.testing.assert_allclose(heal_seams(picture, stay(), HOLE), picture, atol=0.5)


def test_a_gradient_copied_from_elsewhere_is_continued_without_a_seam() -> None:
    ramp = np.stack([2 * COLUMNS, 3 * COLUMNS + ROWS, 255 - 2 * COLUMNS], axis=-1)
    field = stay()
    field[HOLE & (COLUMNS < 32)] += [0, -15]
    field[HOLE & (COLUMNS >= 32)] += [8, 14]
    patched = copied(ramp, field)
    assert np.abs(patched - ramp).max() > 15, "the copies do not fit"
    np.testing.assert_allclose(heal_seams(patched, field, HOLE), ramp, atol=1.0)


def test_an_edge_that_its_source_shows_stays_sharp() -> None:
    picture = np.repeat(np.where(ROWS < 24, 40.0, 200.0).astype(np.float32)[..., None], 3, axis=-1)
    field = stay()
    field[HOLE] += [0, -16]
    healed = heal_seams(copied(picture, field), field, HOLE)
    np.testing.assert_allclose(healed, picture, atol=1.0)


@pytest.mark.parametrize("channels", [1, 3])
def test_a_membrane_takes_the_divergence_that_is_asked_for(channels: int) -> None:
    bowl = np.repeat((0.5 * COLUMNS**2 - 0.25 * ROWS**2)[..., None], channels, axis=-1)
    divergence = np.full((48, 64, channels), 0.5, np.float32)  # second differences: 1 along rows, -1/2 across
    found = membrane(bowl, HOLE, 6, divergence)
    np.testing.assert_allclose(found[HOLE], bowl[HOLE], atol=0.02 * np.ptp(bowl[HOLE]))
