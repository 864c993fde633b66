"""What a collection shows, of photographs of which it is known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from engine.perception.face.head_pose import canonical_face
from engine.persona.collection.coverage import COVERED_EXPRESSIONS, rare, shown_expressions, shown_sides


@dataclass(frozen=True)
class Face:
    """What is asked of a photograph's face."""

    mesh: np.ndarray
    yaw: float = 0.0
    pitch: float = 0.0


def at_rest() -> np.ndarray:
    return canonical_face().astype(np.float32) * 10


def moved(vertices: list[int], by: tuple[float, float]) -> np.ndarray:
    mesh = at_rest()
    mesh[vertices, :2] += np.array(by, np.float32) * np.linalg.norm(mesh[33] - mesh[263])
    return mesh


@pytest.mark.parametrize(
    ("expression", "mesh"),
    [
        ("an open mouth", moved([14], (0, 0.1))),
        ("a smile", moved([61, 291], (0, -0.15))),
        ("mouth corners drawn down", moved([61, 291], (0, 0.15))),
        ("raised brows", moved([107, 336, 70, 300], (0, -0.1))),
        ("lowered brows", moved([107, 336], (0, 0.1))),
    ],
)
def test_an_expression_is_counted_as_what_it_is(expression: str, mesh: np.ndarray) -> None:
    faces = [*[Face(at_rest())] * 7, Face(mesh), Face(mesh)]
    found = shown_expressions(faces)  # type: ignore[arg-type]
    assert found == dict.fromkeys(COVERED_EXPRESSIONS, 0) | {expression: 2}


def test_sides_are_counted() -> None:
    angles = [*[(0, 0)] * 3, (5, 5), (-20, 0), (20, -20), (20, 0), (-3, 15), (3, 15), (0, 30)]
    found = shown_sides([Face(at_rest(), *one) for one in angles])  # type: ignore[arg-type]
    assert list(found.items()) == [
        ("from before", 4),
        ("turned to the picture's left", 1),
        ("turned to the picture's right", 2),
        ("raised", 1),
        ("lowered", 3),
    ]


def test_few_are_told_in_words() -> None:
    assert rare({"a smile": 8, "raised brows": 3, "shut eyes": 0}) == "raised brows (3), shut eyes (none)"
    assert rare({"a smile": 9}) == ""


def test_nothing_shows_nothing() -> None:
    assert set(shown_expressions([]).values()) == {0}
