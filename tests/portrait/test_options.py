"""What a user may choose: what cannot be is refused before any work is done."""

from __future__ import annotations

import pytest
from pydantic import ValidationError

from engine.portrait import PortraitOptions


def test_a_part_ends_after_its_start() -> None:
    assert PortraitOptions.model_validate({"trim": [1, 1.001]}).trim == (1, 1.001)
    for trim in ([3, 1], [1, 1], [0, 0]):
        with pytest.raises(ValidationError, match=r"not after its start") as caught:
            PortraitOptions.model_validate({"trim": trim})
        assert [error["loc"] for error in caught.value.errors()] == [("trim",)]
