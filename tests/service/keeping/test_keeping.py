"""Files kept under names: each name once, what is built in beside them, and nothing left of what was erased."""

from __future__ import annotations

from io import BytesIO

import pytest

from service.clock import now
from service.context import Context
from service.ids import new_id
from service.keeping import service
from service.libraries.library import DRIVER_LIBRARY, MOTION_LIBRARY
from service.problems import Problem
from service.tables.files import File


def uploaded(context: Context, content_type: str = "video/mp4") -> str:
    """The id of an uploaded file."""
    file = File(
        **{"id": new_id(), "owner": "local", "name": "me.mp4", "content_type": content_type, "size": 1},
        **{"sha256": "0" * 64, "created_at": now()},
    )
    with context.database.write() as session:
        session.add(file)
        session.flush()
        context.storage.put(file.key, BytesIO(b"x"))
    return file.id


def refused(code: str) -> pytest.RaisesExc[Problem]:
    return pytest.raises(Problem, check=lambda problem: problem.code == code)


def test_a_name_leads_to_its_file_until_it_is_given_up(context: Context) -> None:
    file = uploaded(context)
    service.keep(context, DRIVER_LIBRARY, "local", "me", file)
    found = service.file_of(context, DRIVER_LIBRARY, "local", "me")
    assert found is not None and found.id == file
    service.rename(context, DRIVER_LIBRARY, "local", "me", "myself")
    assert service.file_of(context, DRIVER_LIBRARY, "local", "me") is None
    assert service.get_kept(context, DRIVER_LIBRARY, "local", "myself").file_id == file
    service.delete(context, DRIVER_LIBRARY, "local", "myself")
    assert service.file_of(context, DRIVER_LIBRARY, "local", "myself") is None
    with context.database.read() as session:
        assert session.get(File, file) is None, "nothing else uses the file"


def test_libraries_have_their_names_apart_and_each_name_once(context: Context) -> None:
    service.keep(context, DRIVER_LIBRARY, "local", "me", uploaded(context))
    service.keep(context, MOTION_LIBRARY, "local", "me", uploaded(context, "text/x-bvh"))
    with refused("name_taken"):
        service.keep(context, DRIVER_LIBRARY, "local", "me", uploaded(context))
    service.keep(context, DRIVER_LIBRARY, "local", "you", uploaded(context))
    with refused("name_taken"):
        service.rename(context, DRIVER_LIBRARY, "local", "you", "me")
    service.rename(context, DRIVER_LIBRARY, "local", "you", "you")


@pytest.mark.parametrize(
    ("name", "code"),
    [
        *(("", "invalid_name"), ("Me", "invalid_name"), ("-me", "invalid_name"), ("a/b", "invalid_name")),
        *(("x" * 64, "invalid_name"), ("auto", "name_taken"), (DRIVER_LIBRARY.built_in[0], "name_taken")),
    ],
)
def test_names_that_nothing_can_have(context: Context, name: str, code: str) -> None:
    with refused(code):
        service.require_free_name(context, DRIVER_LIBRARY, "local", name)


def test_an_id_is_no_name(context: Context) -> None:
    with refused("invalid_name"):
        service.require_free_name(context, DRIVER_LIBRARY, "local", new_id())


def test_what_is_kept_is_there_of_the_right_kind_and_its_keeper_s(context: Context) -> None:
    with refused("unknown_file"):
        service.keep(context, DRIVER_LIBRARY, "local", "me", new_id())
    with refused("input_wrong_media"):
        service.keep(context, DRIVER_LIBRARY, "local", "me", uploaded(context, "image/png"))
    service.keep(context, DRIVER_LIBRARY, "local", "me", uploaded(context))
    with refused("driver_not_found"):
        service.get_kept(context, DRIVER_LIBRARY, "somebody else", "me")
    with refused("driver_built_in"):
        service.delete(context, DRIVER_LIBRARY, "local", DRIVER_LIBRARY.built_in[0])
