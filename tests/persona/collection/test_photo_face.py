"""What is measured of a face in a photograph."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from engine.media.image import read_image
from engine.perception.identity.backend import face_descriptor
from engine.persona.collection.photo_face import LOOKED_AT_SIDE_PIXELS, as_looked_at, faces_of

SAMPLE = Path(__file__).resolve().parents[3] / "web/public/samples/eileen-collins.jpg"


@pytest.fixture(scope="module")
def picture() -> np.ndarray:
    return as_looked_at(read_image(SAMPLE).rgb)


def test_one_face_is_found_and_measured(picture: np.ndarray) -> None:
    (face,) = faces_of(picture, 3, face_descriptor({}))
    assert face.photo == 3 and face.mesh.shape == (478, 3) and face.size_share == 1
    assert abs(face.yaw) < 25 and abs(face.pitch) < 20
    iris = np.linalg.norm(face.mesh[468, :2] - face.mesh[473, :2])
    assert face.eye_distance == pytest.approx(iris, rel=0.15)
    assert face.descriptor.shape == (128,) and face.chip.shape == (112, 112)


def test_blur_is_of_the_face_and_not_of_the_files_size(picture: np.ndarray) -> None:
    describe = face_descriptor({})
    (sharp,) = faces_of(picture, 0, describe)
    (soft,) = faces_of(cv2.GaussianBlur(picture, (0, 0), sharp.eye_distance / 8), 0, describe)
    small = cv2.resize(picture, None, fx=0.6, fy=0.6, interpolation=cv2.INTER_AREA)
    (half,) = faces_of(small, 0, describe)
    assert soft.blur > 0.62 > sharp.blur
    assert half.blur == pytest.approx(sharp.blur, abs=0.08)


def test_a_large_photograph_is_shrunk_and_a_small_one_left() -> None:
    assert as_looked_at(np.zeros((2400, 3200, 3), np.uint8)).shape == (
        LOOKED_AT_SIDE_PIXELS * 3 // 4,
        LOOKED_AT_SIDE_PIXELS,
        3,
    )
    assert as_looked_at(np.zeros((40, 30, 3), np.uint8)).shape == (40, 30, 3)


def test_where_nobody_is_nothing_is_found() -> None:
    assert faces_of(np.full((300, 400, 3), 127, np.uint8), 0, face_descriptor({})) == []


def test_whoever_stands_beside_is_counted(picture: np.ndarray) -> None:
    describe = face_descriptor({})
    (alone,) = faces_of(picture, 0, describe)
    low, high = (np.rint(one).astype(int) for one in (alone.mesh[:, :2].min(axis=0), alone.mesh[:, :2].max(axis=0)))
    width = int(high[0] - low[0])
    bust = picture[max(0, low[1] - width) : high[1] + width, max(0, low[0] - width // 2) : high[0] + width // 2]
    pair = faces_of(np.ascontiguousarray(np.hstack([bust, bust])), 1, describe)
    assert alone.beside == 0 and [face.beside for face in pair] == [1, 1]
