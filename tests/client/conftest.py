"""A service that the client talks to, and a line to it that breaks."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from running import Running

from galatea_client import Client


@pytest.fixture(scope="session")
def shared_service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """A service that the tests of this folder share."""
    service = Running(tmp_path_factory.mktemp("data") / "data", image_mb=1, allowed_networks="127.0.0.0/8")
    yield service
    service.stop()


@pytest.fixture
def galatea(running: Running) -> Iterator[Client]:
    """A client of it."""
    with Client(str(running.client.base_url)) as client:
        yield client


@pytest.fixture
def picture(tmp_path: Path) -> Path:
    """The file of a small picture."""
    path = tmp_path / "picture.png"
    Image.fromarray(np.random.default_rng(7).integers(0, 256, (20, 30, 3), np.uint8)).save(path)
    return path
