"""An option that a job kind does not have is answered with those that it has."""

from __future__ import annotations

import pytest
from pydantic import BaseModel, ConfigDict, ValidationError

from engine.unknown_options import with_suggestions


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
