"""A collection of photographs of one person: the actor of the built-in performances."""

from __future__ import annotations

import numpy as np
import pytest

from engine.media.video import read_video
from engine.perception.faces import FaceTracker
from engine.performances import video

FRAMES_OF_EACH = 4


@pytest.fixture(scope="session")
def collection() -> tuple[np.ndarray, list[np.ndarray]]:
    """Meshes (N, 478, 3) and photographs of six performances."""
    meshes, photos = [], []
    for name in ("happy", "happy-strong", "surprise", "anger", "sadness", "fear"):
        frames = [frame.rgb for frame in read_video(video(name))]
        for index in np.linspace(0, len(frames) - 1, FRAMES_OF_EACH).astype(int):
            with FaceTracker(alone=True) as tracker:
                found = tracker(frames[index])
            if found:
                meshes.append(found[0])
                photos.append(frames[index])
    return np.array(meshes), photos
