"""Who lies, sits or holds their hands up, in pictures: what is said of them rests on what perception finds there."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchmarks.known_truth.dressed_template import ARMS_DOWN, Look, dress
from benchmarks.known_truth.known_person import PERSON_PICTURE_SIZE, draw_into
from engine.body.shape import Phenotype
from engine.character.figure.figure import Choice, find_figure
from engine.character.sample import FLOOR_COLOUR, WALL_COLOUR
from engine.errors import InputError
from engine.media.image import read_image, write_image
from engine.media.limits import Limits

SEATED = ARMS_DOWN | {
    **{"LeftUpLeg": (-88, 6, 0), "RightUpLeg": (-88, -6, 0)},
    **{"LeftLeg": (88, 0, 0), "RightLeg": (88, 0, 0)},
}
OVERHEAD = {
    **{"LeftArm": (0, 0, 70), "RightArm": (0, 0, -70)},
    **{"LeftForeArm": (0, 0, 70), "RightForeArm": (0, 0, -70)},
}


def told(photo: Path) -> list[str]:
    warnings: list[str] = []
    find_figure(photo, Choice(), False, Limits(), lambda code, message: warnings.append(code))
    return warnings


@pytest.mark.parametrize(
    ("turns", "expected"), [(ARMS_DOWN, []), (SEATED, ["person_seated"]), (OVERHEAD, ["hands_overhead"])]
)
def test_who_is_drawn_in_a_posture_is_told_of(
    tmp_path: Path, turns: Mapping[str, tuple[float, float, float]], expected: list[str]
) -> None:
    """Looked at: they sit with their knees towards the camera, and hold their hands together above the head."""
    person = dress(Look("somebody", Phenotype(gender=0.5), turns, (70, 110, 170), (60, 58, 66)))
    wall = np.full((*PERSON_PICTURE_SIZE, 3), WALL_COLOUR, np.uint8)
    wall[round(0.9 * PERSON_PICTURE_SIZE[0]) :] = FLOOR_COLOUR
    room = 1.3 * float(np.ptp(person.vertices[:, 1]))  # above the head, and before the feet of who sits
    write_image(tmp_path / "photo.png", draw_into(replace(person, height=room), wall).rgb)
    assert told(tmp_path / "photo.png") == expected


@pytest.mark.parametrize("quarters", [1, 2, 3])
def test_who_lies_in_a_real_picture_is_refused(media: Callable[[str], Path], tmp_path: Path, quarters: int) -> None:
    rgb = read_image(media("fullbody/iper_apose_1.jpg")).rgb
    write_image(tmp_path / "photo.png", np.ascontiguousarray(np.rot90(rgb, quarters)))
    with pytest.raises(InputError) as refused:
        told(tmp_path / "photo.png")
    assert refused.value.code == "person_lying"


@pytest.mark.parametrize("partial", [False, True])
def test_who_has_no_head_in_the_picture_is_refused(media: Callable[[str], Path], tmp_path: Path, partial: bool) -> None:
    """Cut off at the neck: perception guesses where the head would be, above the picture."""
    rgb = read_image(media("fullbody/woman_white_top_shorts.jpg")).rgb
    neck = round(0.19 * len(rgb))
    write_image(tmp_path / "photo.png", np.ascontiguousarray(rgb[neck:]))
    with pytest.raises(InputError) as refused:
        find_figure(tmp_path / "photo.png", Choice(), partial, Limits(), lambda code, message: None)
    assert (refused.value.code, "head" in refused.value.detail) == ("not_full_body", True)
