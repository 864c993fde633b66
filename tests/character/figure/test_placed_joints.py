"""Joints placed by hand that can be nobody's."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.character_figures.steps import JOINTS_PLACED_BY_HAND
from engine.character import KIND
from engine.character.figure.figure import Choice, find_figure
from engine.character.figure.placed_joints import (
    PLACEABLE_JOINTS,
    REQUIRED_PLACED_JOINTS,
    check_places,
    check_skeleton,
    in_words,
)
from engine.character.sample import sample_picture
from engine.errors import InputError
from engine.media.image import write_image
from engine.media.limits import Limits
from engine.perception.pose.body import BODY_LANDMARKS

DRAWN = JOINTS_PLACED_BY_HAND["drawing_child_boy"]


def told(places: dict[str, tuple[float, float]]) -> list[str]:
    points = np.zeros((len(BODY_LANDMARKS), 2))
    for name, place in places.items():
        points[BODY_LANDMARKS.index(name)] = place
    warnings: list[str] = []
    check_skeleton(points, lambda code, message: warnings.append(code))
    return warnings


def refused(photo: Path, *placed: tuple[str, float, float]) -> InputError:
    with pytest.raises(InputError) as raised:
        find_figure(photo, Choice(placed=placed), False, Limits(), lambda code, message: None)
    assert set(raised.value.correctable) <= {*KIND.correctable, *(item.name for item in KIND.inputs if item.corrects)}
    return raised.value


def test_a_drawn_childs_joints_are_a_skeleton() -> None:
    assert told(dict(DRAWN)) == []


def test_whoever_is_seen_from_the_side_has_a_skeleton() -> None:
    """Left and right in one place, an elbow bent by fifteen degrees."""
    side = {"Shoulder": (200, 100), "Elbow": (190, 160), "Wrist": (200, 220), "Hip": (200, 240), "Knee": (210, 330)}
    places = {f"{which}{joint}": place for which in ("Left", "Right") for joint, place in side.items()}
    assert told({**places, "LeftAnkle": (170, 410), "RightAnkle": (215, 420)}) == []


@pytest.mark.parametrize(
    "places",
    [
        dict.fromkeys(REQUIRED_PLACED_JOINTS, (200.0, 200.0)),
        {name: (40.0 + 10 * i, 50.0 + 25 * i) for i, name in enumerate(REQUIRED_PLACED_JOINTS)},
        {**DRAWN, **{f"{side}{joint}": (260.0, 300.0) for side in ("Left", "Right") for joint in ("Shoulder", "Hip")}},
    ],
    ids=["one point", "one line", "no trunk"],
)
def test_what_is_no_skeleton_is_refused(tmp_path: Path, places: dict[str, tuple[float, float]]) -> None:
    write_image(tmp_path / "wall.png", np.full((600, 600, 3), 200, np.uint8))
    error = refused(tmp_path / "wall.png", *((name, *place) for name, place in places.items()))
    assert (error.code, error.correctable) == ("joints_invalid", ("joints",))


def test_a_limb_far_too_long_is_told_of() -> None:
    """The trunk is 180 pixels long, the shin then 470."""
    x, y = DRAWN["LeftKnee"]
    assert told({**DRAWN, "LeftAnkle": (x, y + 440)}) == []
    assert told({**DRAWN, "LeftAnkle": (x, y + 470)}) == ["joints_out_of_proportion"]


def test_what_is_refused_of_joints_can_be_corrected_by_them(tmp_path: Path) -> None:
    write_image(tmp_path / "photo.png", sample_picture())
    assert refused(tmp_path / "photo.png", ("Tail", 10, 10)).correctable == ("joints",)
    assert refused(tmp_path / "photo.png", ("LeftKnee", 10_000, 10)).correctable == ("joints",)
    write_image(tmp_path / "far.png", np.full((600, 600, 3), 200, np.uint8))
    small = ((name, x / 8, y / 8) for name, (x, y) in DRAWN.items())
    error = refused(tmp_path / "far.png", *small)
    assert (error.code, error.correctable) == ("person_too_small", ("joints", "person_box"))


def test_landmarks_are_told_in_plain_words_and_a_pair_of_them_once() -> None:
    assert (
        in_words(REQUIRED_PLACED_JOINTS)
        == "both shoulders, both elbows, both wrists, both hips, both knees, both ankles"
    )
    assert in_words(["RightKnee", "Nose", "LeftAnkle"]) == "the right knee, the nose, the left ankle"
    assert in_words(["LeftIndex", "RightFootIndex"]) == "the left index finger, the right toes"
    assert not any(letter.isupper() for letter in in_words(PLACEABLE_JOINTS))


def test_refusals_and_warnings_name_joints_in_plain_words() -> None:
    with pytest.raises(InputError, match="For the left knee a place far outside the picture") as refused:
        check_places({"LeftKnee": (10_000, 10)}, (100, 100))
    assert refused.value.code == "joint_outside"
