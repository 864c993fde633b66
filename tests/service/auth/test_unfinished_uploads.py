"""Which uploads count towards how many a key may have at once."""

from __future__ import annotations

from datetime import timedelta

from service.auth.repository import unfinished_uploads
from service.clock import now
from service.context import Context
from service.ids import new_id
from service.keys.schemas import KeyIn
from service.keys.service import create
from service.tables.keys import LOCAL_KEY_ID
from service.tables.uploads import Upload


def upload(owner: str, expires_in: timedelta) -> Upload:
    return Upload(
        **{"id": new_id(), "owner": owner, "name": "video.mp4", "declared": "", "length": 100, "received": 10},
        **{"created_at": now(), "expires_at": now() + expires_in},
    )


def test_those_count_that_more_may_come_of_and_only_the_key_s_own(context: Context) -> None:
    hour = timedelta(hours=1)
    with context.database.write() as session:
        other, _ = create(session, KeyIn(name="another"))
        session.flush()
        session.add_all([upload(LOCAL_KEY_ID, hour), upload(LOCAL_KEY_ID, -hour), upload(other.id, hour)])
        session.flush()
        assert unfinished_uploads(session, LOCAL_KEY_ID) == 1
