"""The job kinds on offer, as an operator names them."""

from __future__ import annotations

import pytest
import tiny_kind

from engine.kinds import KINDS
from service.catalogue.registry import load_kinds, require_known


def test_a_place_holds_one_kind_or_many_and_the_last_of_a_name_counts() -> None:
    kinds = load_kinds(["tiny_kind:KIND", "engine.kinds"])
    assert list(kinds) == ["tiny", *KINDS]
    assert kinds["tiny"] is tiny_kind.KIND and kinds["portrait"] is KINDS["portrait"]


def test_what_is_no_kind_is_refused_by_its_place() -> None:
    with pytest.raises(TypeError, match=r"engine\.store:__dict__"):
        load_kinds(["engine.store:__dict__"])


def test_a_worker_serves_only_kinds_that_there_are() -> None:
    require_known([], KINDS)
    require_known(["portrait"], KINDS)
    with pytest.raises(ValueError, match=r"no job kind sculpture; there are .*portrait"):
        require_known(["portrait", "sculpture"], KINDS)
