"""Emotions as prototypes in the space of expressions: clear movements show them, and halves and opposites do not."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from engine.media.image import read_image
from engine.perception.expression.measures import MEASURES, general_rest, measure
from engine.perception.expression.prototypes import CLEAR_MOVEMENTS, PROTOTYPES, show
from engine.perception.face.faces import find_faces


def shown(**moved: float) -> dict[str, float]:
    """How clearly a face shows each emotion whose measures differ from rest by so much."""
    values = np.zeros((1, len(MEASURES)))
    for name, by in moved.items():
        values[0, MEASURES.index(name)] = by
    return {state: float(clearly[0]) for state, clearly in show(values, general_rest()).items()}


def corners(up: float, wider: float) -> dict[str, float]:
    return {"right_corner_up": up, "left_corner_up": up, "mouth_wide": wider}


def test_a_face_at_rest_shows_nothing() -> None:
    assert shown() == dict.fromkeys(PROTOTYPES, 0.0)


def test_a_smile_shows_as_clearly_as_the_least_clear_of_what_it_needs() -> None:
    up, wider = CLEAR_MOVEMENTS["corners_up"], CLEAR_MOVEMENTS["mouth_wider"]
    assert shown(**corners(up, wider))["happy"] == pytest.approx(1)
    assert shown(**corners(2 * up, 0.5 * wider))["happy"] == pytest.approx(0.5)
    assert shown(**corners(up, 2 * wider) | {"left_corner_up": 0.0})["happy"] == 0, "one corner alone is no smile"


def test_a_frown_speaks_against_itself_where_the_mouth_smiles() -> None:
    frown = {"inner_brows_up": -0.08, "outer_brows_up": -0.08, "brows_apart": -0.05}
    up, wider = CLEAR_MOVEMENTS["corners_up"], CLEAR_MOVEMENTS["mouth_wider"]
    assert shown(**frown)["anger"] >= 1
    assert shown(**frown, **corners(up, wider))["anger"] == 0


@pytest.mark.parametrize("eye", ["right_eye_open", "left_eye_open"])
def test_one_eye_that_shuts_winks_and_two_blink(eye: str) -> None:
    shutting = -0.95 * general_rest()[MEASURES.index(eye)]
    assert shown(**{eye: shutting})["wink"] >= 1
    assert shown(right_eye_open=shutting, left_eye_open=shutting)["wink"] == 0
    assert shown(**{eye: shutting}, yaw=0.5)["wink"] == 0, "seen too obliquely to tell"


def test_a_smile_is_the_difference_between_two_photographs_of_one_woman(media: Callable[[str], Path]) -> None:
    quiet, smiling = (
        find_faces(read_image(media(f"portraits/pair1_{name}.png")).rgb)[0] for name in ("neutral", "smile")
    )
    rest = measure(quiet[None])[0]
    shown = show(measure(smiling[None]) - rest, rest)
    assert shown["happy"][0] >= 1
    assert max(clearly[0] for state, clearly in shown.items() if state != "happy") < 0.5
