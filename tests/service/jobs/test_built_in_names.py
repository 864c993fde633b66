"""The name of something built in stands for an option, unless the owner keeps something under that name."""

from __future__ import annotations

import pytest

from engine.kind import Input, Kind
from service.clock import now
from service.context import Context
from service.ids import new_id
from service.jobs.inputs import Value, named_options
from service.keys.schemas import KeyIn
from service.keys.service import create
from service.libraries.library import MOTION_LIBRARY
from service.tables.files import File
from service.tables.kept import Motion
from service.tables.keys import LOCAL_KEY_ID

INPUT = Input("motion", "motion", "", named_by="motion", library=MOTION_LIBRARY.name)
KIND = Kind("dance", "", [INPUT], None, None)  # type: ignore[arg-type]


@pytest.mark.parametrize("mine", [False, True], ids=["another keeps it", "the owner keeps it"])
def test_what_the_owner_keeps_goes_before_what_is_built_in(context: Context, mine: bool) -> None:
    """As where a motion was kept before one of its name was built in."""
    name = MOTION_LIBRARY.built_in[0]
    with context.database.write() as session:
        other, _ = create(session, KeyIn(name="another"))
        session.flush()
        owner = LOCAL_KEY_ID if mine else other.id
        file = File(
            **{"id": new_id(), "owner": owner, "name": "a.bvh", "content_type": "text/plain", "size": 1},
            **{"sha256": "", "created_at": now()},
        )
        session.add(file)
        session.flush()
        session.add(Motion(owner=owner, name=name, file_id=file.id, created_at=now()))
        session.flush()
        given: dict[str, Value] = {"motion": name}
        found = named_options(session, LOCAL_KEY_ID, KIND, given)
    assert (found, given) == (({}, {"motion": name}) if mine else ({"motion": name}, {"motion": None}))
