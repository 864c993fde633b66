"""What stands out beside people: held things come with them whole, others stay away, and limbs that joints tell of stay."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np

from engine.media.image import read_image
from engine.package_data import package_data
from engine.perception.masks.salience import MODEL_FILE, MODEL_SHA256, salience, with_salience
from engine.perception.masks.segmentation import people_confidence


def test_the_network_is_the_one_that_set_up_takes() -> None:
    content = package_data("engine.perception", MODEL_FILE).read_bytes()
    assert hashlib.sha256(content).hexdigest() == MODEL_SHA256


def test_what_stands_out_is_seen_and_a_mirrored_picture_gives_the_mirrored_map() -> None:
    disk = np.full((320, 320, 3), (190, 195, 200), np.uint8)
    cv2.circle(disk, (120, 160), 60, (150, 60, 40), -1)
    truth = np.hypot(*(np.mgrid[:320, :320] - np.array([160, 120])[:, None, None])) < 60
    found = salience(disk) > 0.5
    assert (found & truth).sum() / (found | truth).sum() > 0.9
    mirrored = salience(np.ascontiguousarray(disk[:, ::-1]))[:, ::-1]
    assert np.abs(mirrored - salience(disk)).mean() < 0.02


def test_without_people_nothing_is_looked_at() -> None:
    nobody = np.zeros((400, 300), np.float32)
    rgb = np.full((400, 300, 3), 120, np.uint8)
    np.testing.assert_array_equal(with_salience(rgb, nobody, nobody > 1, np.zeros((0, 2))), nobody)


def test_a_thing_is_somebodys_as_a_whole_if_it_reaches_their_hand(media: Callable[[str], Path]) -> None:
    """A bag that hangs from a hand, in a picture of 720x960: the networks of people see nothing of it."""
    rgb = read_image(media("fullbody/woman_hat_bag.png")).rgb
    people = people_confidence(rgb, whole=True)
    scale = people.shape[0] / rgb.shape[0]
    bag = tuple(slice(round(a * scale), round(b * scale)) for a, b in ((750, 860), (135, 200)))
    none = np.zeros(rgb.shape[:2], np.bool_)
    assert people[bag].max() < 0.3
    held = with_salience(rgb, people, none, np.array([[230.0, 560.0]]))[bag]
    assert (held > 0.5).mean() > 0.98
    np.testing.assert_array_equal(with_salience(rgb, people, none, np.array([[470.0, 560.0]]))[bag], people[bag])


def test_where_joints_tell_of_limbs_belief_does_not_fall() -> None:
    """Somebody whom nothing tells from the wall: nothing stands out."""
    rgb = np.full((400, 300, 3), 120, np.uint8)
    people = np.zeros((400, 300), np.float32)
    people[60:340, 110:190] = 0.9
    limbs = people > 0.5
    limbs[:, 150:] = False
    belief = with_salience(rgb, people, limbs, np.zeros((0, 2)))
    assert (belief[limbs] >= 0.9 - 1e-6).all()
    assert belief[(people > 0.5) & ~limbs].mean() < 0.8
