"""Flags say what JSON says: each option of the kinds has one, and its text becomes the value that the API would take."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from pydantic import BaseModel

from engine.character.options import CharacterOptions
from engine.face_animation.acting_options import ACTING_PARTS
from engine.portrait.options import PortraitOptions
from shell.option_flags import PARAMETER_PREFIX, flag_of, form_of, given_options, option_flags


@pytest.mark.parametrize("options", [PortraitOptions, CharacterOptions])
def test_every_option_has_a_flag_but_those_that_are_taken(options: type[BaseModel]) -> None:
    flags = {flag for option in option_flags(options, {"fps"}) for flag in option.opts}
    assert flags == {flag_of(name) for name in options.model_fields} - {"--fps"}


@pytest.mark.parametrize(
    ("options", "name", "said", "means"),
    [
        (PortraitOptions, "strength", "0.8", 0.8),
        (PortraitOptions, "follow", "eyes,mouth", ("eyes", "mouth")),
        (PortraitOptions, "follow", "head", ("head",)),
        (PortraitOptions, "follow", "all", ACTING_PARTS),
        (PortraitOptions, "follow", '["brows"]', ("brows",)),
        (PortraitOptions, "crop", "bust", "bust"),
        (PortraitOptions, "crop", "10,20,300,400.5", (10, 20, 300, 400.5)),
        (PortraitOptions, "size", "640x480", (640, 480)),
        (PortraitOptions, "size", "640,480", (640, 480)),
        (PortraitOptions, "trim", "0.5,2", (0.5, 2.0)),
        (PortraitOptions, "sound", True, True),
        (PortraitOptions, "reactive", "true", True),
        (PortraitOptions, "reactive", "happy", ("happy",)),
        (PortraitOptions, "reactive", "happy,idle", ("happy", "idle")),
        (CharacterOptions, "person_index", "all", "all"),
        (CharacterOptions, "person_index", "2", 2),
        (CharacterOptions, "vrm_author", "1984", "1984"),
        (CharacterOptions, "motion_clip", "@home", "@home"),
        (CharacterOptions, "joints", '{"LeftArm": [30, 40]}', {"LeftArm": (30.0, 40.0)}),
    ],
)
def test_a_flag_says_what_json_says(options: type[BaseModel], name: str, said: Any, means: Any) -> None:
    chosen = options.model_validate(
        given_options(options, {PARAMETER_PREFIX + name: said, PARAMETER_PREFIX + "fps": None})
    )
    assert getattr(chosen, name) == means


def test_lists_of_numbers_tell_their_form_by_an_example_that_is_right() -> None:
    told = {}
    for options in (PortraitOptions, CharacterOptions):
        flags = {option.name: option for option in option_flags(options, ())}
        for name, field in options.model_fields.items():
            if form := form_of(field):
                told[flag_of(name)] = form
                example = form.split("such as ")[1]
                assert options.model_validate(given_options(options, {PARAMETER_PREFIX + name: example}))
                assert f"For instance {example}." in (flags[PARAMETER_PREFIX + name].help or "")
    assert told["--size"] == "N,N, such as 300x300"
    assert told["--trim"] == "NUMBER,NUMBER, such as 0.5,2"
    assert told["--crop"] == "none|face|bust|NUMBER,NUMBER,NUMBER,NUMBER, such as 10,20,300,400"


def test_json_may_be_in_a_file(tmp_path: Path) -> None:
    (tmp_path / "joints.json").write_text('{"Hips": [1, 2]}')
    given = {PARAMETER_PREFIX + "joints": f"@{tmp_path / 'joints.json'}"}
    assert given_options(CharacterOptions, given) == {"joints": {"Hips": [1, 2]}}
