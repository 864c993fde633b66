"""Who does not act stays where they are."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from engine.face_animation.warping.bystanders import own_share
from engine.face_animation.warping.layers import separate_layers
from engine.media.image import read_image, write_image
from engine.media.limits import Limits
from engine.media.video import read_video
from engine.perception.face.faces import find_faces
from engine.portrait.options import PortraitOptions
from engine.portrait.target import find_target_face
from galatea import animate

SIDE = 360


@pytest.fixture(scope="module")
def one(media: Callable[[str], Path]) -> NDArray[np.uint8]:
    return square(media("portraits/photo_woman_white.png"))


@pytest.fixture(scope="module")
def other(media: Callable[[str], Path]) -> NDArray[np.uint8]:
    return square(media("portraits/photo_man_suit.png"))


def square(path: Path) -> NDArray[np.uint8]:
    rgb = read_image(path, Limits()).rgb
    side = min(rgb.shape[:2])
    left = (rgb.shape[1] - side) // 2
    return cv2.resize(rgb[:side, left : left + side], (SIDE, SIDE), interpolation=cv2.INTER_AREA)


def boxes(rgb: NDArray[np.uint8]) -> NDArray[np.float32]:
    """From left to right."""
    found = [np.array([*m[:, :2].min(0), *np.ptp(m[:, :2], axis=0)], np.float32) for m in find_faces(rgb)]
    return np.array(sorted(found, key=lambda box: box[0]))


def test_the_other_of_two_people_does_not_move(
    one: NDArray[np.uint8], other: NDArray[np.uint8], tmp_path: Path
) -> None:
    acting = 1
    both = np.hstack([one, other])
    write_image(tmp_path / "both.png", both)
    largest_first = np.argsort(-boxes(both)[:, 2])
    index = int(np.flatnonzero(largest_first == acting)[0])
    animate(tmp_path / "both.png", "nod", tmp_path / "out", face_index=index, trim=(0, 1.2))
    frames = read_video(tmp_path / "out" / "animation.mp4")
    shown = np.stack([frame.rgb for frame in frames][::6]).astype(np.float32)
    x, y, width, height = boxes(both)[1 - acting].astype(int)
    still = shown[:, y : y + height, x : x + width]
    x, y, width, height = boxes(both)[acting].astype(int)
    acts = shown[:, y : y + height, x : x + width]
    assert np.abs(still - still[0]).mean() < 0.5, "what is left is the encoder's"
    assert np.abs(acts - acts[0]).mean() > 5


def test_of_two_who_overlap_each_keeps_their_own(
    one: NDArray[np.uint8], other: NDArray[np.uint8], media: Callable[[str], Path], tmp_path: Path
) -> None:
    """One cut out before the other: which pixel is whose is known."""
    write_image(tmp_path / "other.png", other)
    face = find_target_face(tmp_path / "other.png", PortraitOptions(), Limits(), lambda code, message: None)
    cut = separate_layers(face).person
    size, left = (SIDE, SIDE * 8 // 5), SIDE * 3 // 5
    scene = np.full((*size, 3), 110, np.uint8)
    scene[:, :SIDE] = one
    front = np.zeros(size, np.float32)
    front[:, left:] = cut[..., 3] / 255
    colours = scene.copy()
    colours[:, left:] = cut[..., :3]
    scene = (colours * front[..., None] + scene * (1 - front[..., None])).astype(np.uint8)
    write_image(tmp_path / "one.png", one)
    behind = find_target_face(tmp_path / "one.png", PortraitOptions(), Limits(), lambda code, message: None)
    back = np.zeros(size, np.float32)
    back[:, :SIDE] = separate_layers(behind).person[..., 3] / 255
    people = np.maximum(front, back)
    seen = boxes(scene)
    assert len(seen) == 2
    found = own_share(scene, people, seen[1], seen[:1]) * people
    overlap = (found * front).sum() / np.maximum(found, front).sum()
    assert overlap > 0.95


def test_whoever_is_far_from_everybody_else_is_whole() -> None:
    """Two faces of 40 pixels, 300 apart: what lies around each is theirs."""
    rgb = np.full((200, 400, 3), 90, np.uint8)
    faces = np.array([[40, 40, 40, 40], [320, 40, 40, 40]], np.float32)
    people = np.ones(rgb.shape[:2], np.float32)
    first, second = (own_share(rgb, people, faces[k], faces[[1 - k]]) for k in (0, 1))
    assert (first[:, :150] == 1).all() and (first[:, 250:] == 0).all()
    shared = np.abs(np.arange(400) - 199.5) < 4  # the border between them is a few pixels wide
    np.testing.assert_allclose((first + second)[:, ~shared], 1, atol=0.01)
