"""People of whom every pixel is known are found where they stand, also one in camouflage."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from benchmarks.known_truth.known_person import PERSON_PICTURE_SIZE, draw_into
from benchmarks.known_truth.known_places import places
from benchmarks.known_truth.scanned_bodies import read_scan
from engine.perception.masks.segmentation import people_confidence
from engine.perception.pose.body import find_body
from engine.perception.pose.people import find_people, person_box


@pytest.mark.parametrize(("place", "stands_out"), [("yard", True), ("garage door", False)])
def test_somebody_who_hardly_stands_out_is_found(media: Callable[[str], Path], place: str, stands_out: bool) -> None:
    soldier = read_scan(media("scans3d/body_soldier/soldier.glb"), -1)
    known = draw_into(soldier, places(PERSON_PICTURE_SIZE)[place])
    assert (find_body(known.rgb) is not None) == stands_out
    (body,) = find_people(known.rgb)
    x, y, wide, high = np.rint(person_box(body, known.rgb.shape)).astype(int)
    there = known.alpha > 0.5
    assert there[y : y + high, x : x + wide].sum() > 0.9 * there.sum()
    assert 0.7 * np.ptp(np.nonzero(there)[0]) < high < 1.2 * np.ptp(np.nonzero(there)[0])


def test_whoever_is_found_by_a_second_look_is_cut_out_by_one(media: Callable[[str], Path]) -> None:
    """What the networks believe is nearer to the truth if the one that finds joints is content with little here too."""
    known = draw_into(
        read_scan(media("scans3d/body_soldier/soldier.glb"), -1), places(PERSON_PICTURE_SIZE)["garage door"]
    )
    there = cv2.resize(known.alpha, (600, 800), interpolation=cv2.INTER_AREA) > 0.5
    content, strict = (people_confidence(known.rgb, whole) > 0.5 for whole in (True, False))
    overlaps = [(seen & there).sum() / (seen | there).sum() for seen in (content, strict)]
    assert overlaps[0] > overlaps[1] + 0.03


def test_where_nobody_is_nobody_is_found() -> None:
    for place in places(PERSON_PICTURE_SIZE).values():
        assert find_people(place) == []
