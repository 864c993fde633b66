"""Masks of the person: colours decide where networks waver, and no specks are left."""

import numpy as np

from engine.avatar.capture.person_masks import settled_masks
from engine.imaging.masks.mask_pieces import pieces_by_area


def test_colours_settle_the_border_and_specks_and_pinholes_go() -> None:
    random = np.random.default_rng(6)
    person = np.zeros((120, 80), np.bool_)
    person[20:110, 25:55] = True
    frame = np.where(person[..., None], [190, 60, 50], [60, 90, 170]) + random.normal(0, 4, (120, 80, 3))
    belief = np.where(person, 0.97, 0.03).astype(np.float32)
    belief[20:110, 20:30] = 0.6  # the networks waver on both sides of the left border
    specks = random.integers(0, [120, 80], (12, 2))
    belief[specks[:, 0], specks[:, 1]] = 1 - belief[specks[:, 0], specks[:, 1]]

    (mask,) = settled_masks([frame.clip(0, 255).astype(np.uint8)], [belief])

    assert (mask & person).sum() / (mask | person).sum() > 0.97
    assert len(pieces_by_area(mask)) == 1
    assert len(pieces_by_area(~mask)) == 1
