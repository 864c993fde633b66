"""Who is filmed in tests: an egg as high as a person, in a colour that the room has not."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from benchmarks.scan_studio.people.subject import Arm, Subject
from benchmarks.scan_studio.scenery.room import Room, furnished_room


@pytest.fixture(scope="session")
def egg() -> Subject:
    """1.8 m high, 0.6 m wide; its left and right thirds are arms that go with the shoulder entirely."""
    ball = trimesh.creation.icosphere(3)
    vertices = np.asarray(ball.vertices) * [0.3, 0.9, 0.3] + [0, 0.9, 0]
    triangles = np.asarray(ball.faces, np.int32)
    uv = np.full((1, 2), 0.5, np.float32)
    arms = tuple(
        Arm((side * vertices[:, 0] > 0.1).astype(float), np.array([side * 0.1, 1.3, 0.0]), 0.5) for side in (1, -1)
    )
    return Subject(
        "egg",
        vertices,
        triangles,
        uv,
        np.zeros_like(triangles),
        np.full((32, 32, 3), (255, 0, 255), np.uint8),
        np.ones(len(vertices), np.float32),
        {"Head": np.array([0.0, 1.55, 0.0])},
        arms,
    )


@pytest.fixture(scope="session")
def plain_room() -> Room:
    """The furnished room, coarsely painted."""
    return furnished_room(0, 32)
