"""Whole runs of the portrait system on small real faces, and one store that they share."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from made_clip import OPENS, read_frames
from numpy.typing import NDArray

from engine.portrait import PortraitOptions
from engine.portrait.pipeline import animate_portrait
from engine.run import Run
from engine.store import StageStore


@dataclass
class Made:
    """What one run left: its folder, the run itself, and the frames of its animation where it is an MP4."""

    out: Path
    run: Run
    frames: list[NDArray[np.uint8]] = field(default_factory=list)


@pytest.fixture(scope="session")
def animation(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Made]:
    """`animation(image, driver, strength=0.5)` runs the whole system once for these arguments, with one store."""
    store = StageStore(tmp_path_factory.mktemp("stages"))
    made: dict[str, Made] = {}

    def make(image: Path, driver: Path, again: bool = False, **options: Any) -> Made:
        key = repr((image, driver, sorted(options.items())))
        if key not in made or again:
            out = tmp_path_factory.mktemp("animated")
            inputs: Mapping[str, Any] = {"image": image, "driver": driver}
            with Run(store=store) as run:
                animate_portrait(inputs, PortraitOptions(**options), out, run)
            made[key] = Made(out, run)
            if (out / "animation.mp4").exists():
                made[key].frames = read_frames(out / "animation.mp4")
        return made[key]

    return make


@pytest.fixture(scope="session")
def opens(animation: Callable[..., Made], woman_white: Path, mouth_opens: Path) -> Made:
    return animation(woman_white, mouth_opens, trim=OPENS, neutral_frame=0)


@pytest.fixture
def driver(mouth_opens: Path) -> Path:
    """The driver of a test that says no other."""
    return mouth_opens


@pytest.fixture
def woman(woman_white: Path) -> Path:
    """The picture of a test that says no other."""
    return woman_white
