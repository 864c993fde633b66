"""A collection of photographs of one person: the actor of the built-in performances."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from engine.media.image import read_image
from engine.perception.face.faces import FaceTracker
from engine.persona.sample import write_sample_photos


@pytest.fixture(scope="session")
def photo_files(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, ...]:
    """The photographs as files."""
    return write_sample_photos(tmp_path_factory.mktemp("collection"))


@pytest.fixture(scope="session")
def collection(photo_files: tuple[Path, ...]) -> tuple[np.ndarray, list[np.ndarray]]:
    """Meshes (N, 478, 3) and photographs, of those that show a face."""
    meshes, photos = [], []
    for path in photo_files:
        photo = read_image(path).rgb
        with FaceTracker(alone=True) as tracker:
            found = tracker(photo)
        if found:
            meshes.append(found[0])
            photos.append(photo)
    return np.array(meshes), photos
