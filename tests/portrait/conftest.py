"""Small real portraits and drivers for the tests of the portrait system, and one store that they share."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from made_clip import OPENS, read_frames
from numpy.typing import NDArray

from engine.media.image import read_image, write_image
from engine.media.video import read_video
from engine.portrait import PortraitOptions
from engine.portrait.pipeline import animate_portrait
from engine.run import Run
from engine.store import StageStore

Media = Callable[[str], Path]


@pytest.fixture(scope="session")
def small(media: Media, tmp_path_factory: pytest.TempPathFactory) -> Callable[[str, int], Path]:
    """`small("photo_biden.jpg", 300)` is that portrait with a longest side of 300 pixels."""
    folder = tmp_path_factory.mktemp("small")

    def make(name: str, longest: int) -> Path:
        path = folder / f"{longest}-{Path(name).stem}.png"
        if not path.exists():
            rgb = read_image(media(f"portraits/{name}")).rgb
            scale = longest / max(rgb.shape[:2])
            size = [2 * round(s * scale / 2) for s in rgb.shape[1::-1]]
            write_image(path, np.asarray(cv2.resize(rgb, size, interpolation=cv2.INTER_AREA)))
        return path

    return make


@pytest.fixture(scope="session")
def clip(media: Media) -> Callable[[str, float, float], list[NDArray[np.uint8]]]:
    """`clip("man_talk_tps.mp4", 1.0, 2.0)`: the frames of that part of a driving clip."""

    def make(name: str, start: float, end: float) -> list[NDArray[np.uint8]]:
        return [f.rgb.copy() for f in read_video(media(f"driving/{name}"), trim=(start, end))]

    return make


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
            run = Run(store=store)
            inputs: Mapping[str, Any] = {"image": image, "driver": driver}
            animate_portrait(inputs, PortraitOptions(**options), out, run)
            made[key] = Made(out, run)
            if (out / "animation.mp4").exists():
                made[key].frames = read_frames(out / "animation.mp4")
        return made[key]

    return make


@pytest.fixture(scope="session")
def mouth_opens(media: Media) -> Path:
    return media("driving/man_mouth_open_d18.mp4")


@pytest.fixture(scope="session")
def woman_white(small: Callable[[str, int], Path]) -> Path:
    return small("photo_woman_white.png", 300)


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
