"""An option that a job kind does not have is answered with those that it has."""

from __future__ import annotations

import pytest
from pydantic import BaseModel, ConfigDict, ValidationError

from engine.unknown_options import with_suggestions
from service.problems import field_errors


class Inner(BaseModel):
    model_config = ConfigDict(extra="forbid")
    width: int = 1


class Options(BaseModel):
    model_config = ConfigDict(extra="forbid")
    strength: float = 1.0
    fps: float = 25.0
    inner: Inner = Inner()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"strenght": 2}, "There is no such option: did you mean strength?"),
        ({"zzz": 2}, "There is no such option: there are fps, inner, strength."),
        ({"inner": {"zzz": 2}}, "Extra inputs are not permitted"),
        ({"fps": "x"}, "Input should be a valid number, unable to parse string as a number"),
    ],
)
def test_what_is_said(given: dict[str, object], said: str) -> None:
    with pytest.raises(ValidationError) as caught:
        Options.model_validate(given)
    assert [error["msg"] for error in with_suggestions(caught.value.errors(), Options)] == [said]


@pytest.mark.parametrize(("name", "said"), [("zzz", "as zzz:"), ("z" * 500, "z…:")])
def test_an_unknown_field_is_answered_with_what_to_do(name: str, said: str) -> None:
    with pytest.raises(ValidationError) as caught:
        Inner.model_validate({name: 2})
    [error] = field_errors(caught.value.errors(), "/options")
    assert (error.pointer, error.code) == (f"/options/{name}", "extra_forbidden")
    assert said in error.detail and "leave it out" in error.detail and len(error.detail) < 200
