"""What this process knows of the uploads under way: which request is at which upload, and the running digests.

A connection that broke is often noticed by its client first: it comes back while the old request still waits for
bytes that will never come. So a later request takes over: the earlier one keeps what it has and lets go.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Annotated

import anyio
from fastapi import Depends, Request

from service.problems import Problem
from service.uploads.digest import RunningDigest

HOLD_TIMEOUT_SECONDS = 10.0
"""How long a later request waits for an earlier one to let go; only one that is storing the whole file takes so long."""

MAX_DIGESTS = 1000


class UploadHold:
    """That one request is at an upload."""

    def __init__(self) -> None:
        self.interruptible = anyio.CancelScope()
        """What the request does in here can be broken off at any moment."""
        self.released = anyio.Event()

    def let_go(self) -> None:
        """Ask the request to come to an end."""
        self.interruptible.cancel()


class ActiveUploads:
    """The uploads under way in this process."""

    def __init__(self) -> None:
        self._holds: dict[str, UploadHold] = {}
        self._digests: OrderedDict[str, RunningDigest] = OrderedDict()

    @asynccontextmanager
    async def hold(self, upload_id: str) -> AsyncIterator[UploadHold]:
        """Be the only request at an upload; an earlier one is asked to let go. Raises a 423 problem if it does not."""
        with anyio.move_on_after(HOLD_TIMEOUT_SECONDS):
            while (earlier := self._holds.get(upload_id)) is not None:
                earlier.let_go()
                await earlier.released.wait()
        if upload_id in self._holds:
            raise Problem(
                423,
                "upload_locked",
                "The upload is being stored by another request: ask again in a moment.",
                headers={"Retry-After": "5"},
            )
        hold = self._holds[upload_id] = UploadHold()
        try:
            yield hold
        finally:
            del self._holds[upload_id]
            hold.released.set()

    def digest(self, upload_id: str) -> RunningDigest:
        """The running digest of an upload; those that were not asked for longest are forgotten."""
        digest = self._digests.setdefault(upload_id, RunningDigest())
        self._digests.move_to_end(upload_id)
        while len(self._digests) > MAX_DIGESTS:
            self._digests.popitem(last=False)
        return digest

    def forget(self, upload_id: str) -> None:
        self._digests.pop(upload_id, None)


async def _under_way(request: Request) -> ActiveUploads:
    under_way: ActiveUploads = request.app.state.uploads
    return under_way


InUnderWay = Annotated[ActiveUploads, Depends(_under_way)]
