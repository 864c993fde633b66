"""The average while photographs are looked at: of the one person, shown with every doubling."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from engine.media.image import read_image
from engine.perception.face.head_pose import canonical_face
from engine.perception.identity.descriptor import IdentityDistances
from engine.persona.collection.photo_face import PhotoFace
from engine.persona.collection.sorting import Choice
from engine.persona.early_average import AVERAGE_SIZE, FIRST_SHOWN, EarlyAverage

GREY, OTHER = 120, 250
PERSON, SOMEBODY = np.float32([1, 0, 0]), np.float32([0, 1, 0])


def photo_face(photo: int, descriptor: np.ndarray) -> PhotoFace:
    """A frontal face in the middle of a photograph of 200 pixels, unlike every other one."""
    mesh = canonical_face() * 50
    mesh[:, :2] += 100
    chip = np.random.default_rng(photo).integers(0, 255, (112, 112)).astype(np.uint8)
    return PhotoFace(photo, mesh.astype(np.float32), 50.0, 0.0, 0.0, 0.2, 1.0, descriptor, chip)


def test_it_is_shown_with_every_doubling_and_is_of_the_one_person(tmp_path: Path) -> None:
    shown: list[np.ndarray] = []

    def publish(path: Path) -> None:
        shown.append(read_image(path).rgb)

    average = EarlyAverage(tmp_path, publish, IdentityDistances(0.6, 0.7), Choice(), False)
    for photo in range(3 * FIRST_SHOWN):
        somebody = photo % 3 == 2
        rgb = np.full((200, 200, 3), OTHER if somebody else GREY + photo % 2, np.uint8)
        average.add(rgb, [photo_face(photo, SOMEBODY if somebody else PERSON)])
    # of twelve photographs eight are the person's: shown at four and at eight of them
    assert len(shown) == 2
    for picture in shown:
        assert picture.shape[:2] == AVERAGE_SIZE
        middle = picture[
            AVERAGE_SIZE[0] // 2 - 20 : AVERAGE_SIZE[0] // 2 + 20, AVERAGE_SIZE[1] // 2 - 20 : AVERAGE_SIZE[1] // 2 + 20
        ]
        assert middle.min() >= GREY and middle.max() <= GREY + 1


def test_photographs_of_nobody_twice_show_nothing(tmp_path: Path) -> None:
    average = EarlyAverage(tmp_path, lambda path: None, IdentityDistances(0.6, 0.7), Choice(), False)
    for photo in range(FIRST_SHOWN):
        alone = np.eye(FIRST_SHOWN, dtype=np.float32)[photo]
        average.add(np.full((200, 200, 3), GREY, np.uint8), [photo_face(photo, alone)])
    assert not (tmp_path / "average.png").exists()
