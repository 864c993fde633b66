"""Collections and drivers as nobody should send them: what becomes of each."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from engine.errors import InputError
from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.media.image import read_image, write_image
from engine.media.limits import Limits
from engine.media.video import read_video
from engine.performances import video
from engine.persona.options import PersonaOptions
from engine.persona.pipeline import make_persona
from engine.run import Run
from engine.store import StageStore

OPTIONS = PersonaOptions(size=(96, 120), composite="none", texture_width=97)
STRANGER = Path(__file__).resolve().parents[2] / "web/public/samples/eileen-collins.jpg"


@pytest.fixture(scope="module")
def at_rest() -> np.ndarray:
    return next(iter(read_video(video("happy")))).rgb.copy()


def lit(photo: np.ndarray, number: int) -> np.ndarray:
    """A photograph in a light of its own, and a little tilted."""
    height, width = photo.shape[:2]
    sides = np.random.default_rng(number).uniform(0.35, 1.65, (3, 3))
    shade = cv2.resize(sides, (width, height), interpolation=cv2.INTER_CUBIC)
    turn = cv2.getRotationMatrix2D((width / 2, height / 2), 8 * np.sin(5.0 * number), 1.0)
    turned = cv2.warpAffine(photo, turn, (width, height), borderMode=cv2.BORDER_REPLICATE)
    return np.clip(np.asarray(turned, float) * np.asarray(shade)[..., None], 0, 255).astype(np.uint8)


def written(folder: Path, photos: list[np.ndarray]) -> tuple[Path, ...]:
    paths = tuple(folder / f"{number:02}.jpg" for number in range(len(photos)))
    for path, photo in zip(paths, photos, strict=True):
        write_image(path, photo)
    return paths


@pytest.fixture(scope="module")
def one_expression(at_rest: np.ndarray, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a persona of photographs that all show the face at rest, with the codes of its warnings beside it."""
    folder = tmp_path_factory.mktemp("one_expression")
    photos = written(folder, [lit(at_rest, number) for number in range(20)])
    with Run(StageStore(folder / "stages")) as run:
        make_persona({"photos": photos}, OPTIONS, folder, run)
    (folder / "warnings.txt").write_text(" ".join(notice.code for notice in run.notices))
    return folder


def refusal(inputs: dict[str, Path | tuple[Path, ...]], out: Path, limits: Limits | None = None) -> InputError:
    with Run(limits=limits) as run, pytest.raises(InputError) as error:
        make_persona(inputs, OPTIONS, out, run)
    return error.value


def test_one_expression_alone_works_and_is_told(one_expression: Path) -> None:
    assert (one_expression / "persona.npz").exists()
    assert "expressions_rare" in (one_expression / "warnings.txt").read_text().split()


def test_small_faces_alone_are_too_few(at_rest: np.ndarray, tmp_path: Path) -> None:
    small = [cv2.resize(lit(at_rest, number), (80, 80), interpolation=cv2.INTER_AREA) for number in range(16)]
    found = refusal({"photos": written(tmp_path, small)}, tmp_path)
    assert found.code == "too_few_photos" and "are too small" in found.detail


def test_a_driver_longer_than_the_limit_is_refused(one_expression: Path, tmp_path: Path) -> None:
    inputs = {"persona": one_expression / "persona.npz", "driver": video("happy")}
    assert refusal(inputs, tmp_path, Limits(video_seconds=0.5)).code == "video_too_long"


def test_a_driver_that_shows_nobody_is_refused(one_expression: Path, tmp_path: Path) -> None:
    filmed(tmp_path / "sky.mp4", [np.full((128, 128, 3), (90, 140, 220), np.uint8)] * 6)
    inputs = {"persona": one_expression / "persona.npz", "driver": tmp_path / "sky.mp4"}
    assert refusal(inputs, tmp_path).code == "no_face_in_driver"


def test_a_driver_that_cuts_to_somebody_else_is_played_to_its_end(
    one_expression: Path, at_rest: np.ndarray, tmp_path: Path
) -> None:
    side = 256
    first = cv2.resize(at_rest, (side, side), interpolation=cv2.INTER_AREA)
    stranger = read_image(STRANGER).rgb
    edge = min(stranger.shape[:2])
    second = cv2.resize(stranger[:edge, :edge], (side, side), interpolation=cv2.INTER_AREA)
    filmed(tmp_path / "cut.mp4", [first] * 6 + [second] * 6)
    inputs = {"persona": one_expression / "persona.npz", "driver": tmp_path / "cut.mp4"}
    with Run() as run:
        make_persona(inputs, OPTIONS, tmp_path, run)
    assert sum(1 for _ in read_video(tmp_path / "animation.mp4")) == 12


def filmed(path: Path, frames: list[np.ndarray]) -> None:
    height, width = frames[0].shape[:2]
    with VideoWriter(VideoTarget(path, (width, height), 12, frames=len(frames)), lambda code, message: None) as writer:
        for frame in frames:
            writer.write(np.ascontiguousarray(frame), None)
