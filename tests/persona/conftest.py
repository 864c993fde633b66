"""A collection of photographs of one person: the actor of the built-in performances."""

from __future__ import annotations

import numpy as np
import pytest

from engine.media.video import read_video
from engine.perception.faces import FaceTracker
from engine.performances import video

PERFORMANCES = (
    "happy",
    "surprise",
    "anger",
    "sadness",
    "fear",
    "happy-strong",
    "surprise-strong",
    "anger-strong",
    "sadness-strong",
)
INSTANTS = (0.25, 0.45, 0.65)
"""Of each of them: at their beginnings and ends he is at rest, which is one photograph many times."""


@pytest.fixture(scope="session")
def collection() -> tuple[np.ndarray, list[np.ndarray]]:
    """Meshes (N, 478, 3) and photographs: three of each performance, and one at rest."""
    meshes, photos = [], []
    for name in PERFORMANCES:
        frames = [frame.rgb for frame in read_video(video(name))]
        for instant in (*((0.0,) if name == "happy" else ()), *INSTANTS):
            photo = frames[round(instant * (len(frames) - 1))]
            with FaceTracker(alone=True) as tracker:
                found = tracker(photo)
            if found:
                meshes.append(found[0])
                photos.append(photo)
    return np.array(meshes), photos
