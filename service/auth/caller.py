"""Who calls: by a key, by a session of the web page, or, where no key is needed, from this machine.

Endpoints take `Reader`, `Submitter` or `Admin`, and so say what their caller must be allowed to do.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Annotated, Literal

import structlog
from fastapi import Depends, Request
from sqlalchemy.exc import DBAPIError
from starlette.requests import HTTPConnection

from service.auth import repository
from service.auth.rate import take_one
from service.auth.sessions import SESSION_COOKIE, key_of_session
from service.auth.wrong_keys import count_wrong_key
from service.clock import now
from service.context import Context
from service.database.sessions import database_full
from service.disk import make_room
from service.problems import Problem
from service.request_context import InContext
from service.tables.keys import LOCAL_KEY_ID, Key

Scope = Literal["read", "submit", "admin"]
SCOPE_MEANINGS: dict[Scope, str] = {
    "read": "look at its own jobs, files, drivers and webhooks",
    "submit": "upload, submit, change and erase them",
    "admin": "manage keys, read the service's figures and let jobs come first",
}


@dataclass(frozen=True)
class Caller:
    """Whom a request comes from."""

    owner: str
    """The id of the key; what the request makes belongs to it."""
    scopes: frozenset[str]

    def require(self, scope: Scope) -> None:
        """Raise a 403 problem if the caller may not do this."""
        if scope not in self.scopes:
            raise Problem(
                403,
                "scope_missing",
                f"The key lacks the scope “{scope}” (to {SCOPE_MEANINGS[scope]}): use one that has it.",
            )


LOCAL_CALLER = Caller(LOCAL_KEY_ID, frozenset(SCOPE_MEANINGS))
"""Whoever is on this machine, where no key is needed."""


def identify(request: Request, context: InContext) -> Caller:
    """The caller of a request, counted against its rate. Raises 401 and 429 problems."""
    caller = caller_of(request, context)
    if request.method == "DELETE" or request.url.path.endswith("/cancel"):
        make_room(context.settings)
    return caller


def caller_of(request: HTTPConnection, context: Context) -> Caller:
    """The caller of a request or of a WebSocket's handshake, counted against its rate. Raises 401 and 429 problems."""
    token = _bearer(request)
    session = request.cookies.get(SESSION_COOKIE)
    if token is None and session is None:
        if context.settings.keys_required:
            raise unknown_key_problem(
                "key_missing", "Send a key: `Authorization: Bearer KEY`. `galatea keys create` makes one."
            )
        return LOCAL_CALLER
    with context.database.read() as reading:
        key = repository.of_token(reading, token) if token is not None else key_of_session(reading, session or "")
    if key is None:
        if token is None and not context.settings.keys_required:
            return LOCAL_CALLER  # an old cookie of the page opens nothing, and shuts nothing either
        if token is not None:
            count_wrong_key(context, request)
        raise unknown_key_problem("key_unknown", "There is no such key: it was revoked, or it never was.")
    if not repository.usable(key, now()):
        raise unknown_key_problem("key_expired", "The key has expired: use another one.")
    take_one(context.queue, key.id, key.requests_per_minute or context.settings.requests_per_minute)
    _note_use(context, key)
    return Caller(key.id, frozenset(key.scopes))


InCaller = Annotated[Caller, Depends(identify)]


def require_scope(scope: Scope) -> Callable[[Caller], Awaitable[Caller]]:
    """A dependency: the caller, who must be allowed to do this."""

    async def allowed(caller: InCaller) -> Caller:
        caller.require(scope)
        return caller

    return allowed


Reader = Annotated[Caller, Depends(require_scope("read"))]
Submitter = Annotated[Caller, Depends(require_scope("submit"))]
Admin = Annotated[Caller, Depends(require_scope("admin"))]


def _bearer(request: HTTPConnection) -> str | None:
    given = request.headers.get("authorization")
    if given is None:
        return None
    scheme, _, token = given.partition(" ")
    if scheme.lower() != "bearer" or not token.strip():
        raise unknown_key_problem("key_malformed", "The Authorization header must read `Bearer KEY`.")
    return token.strip()


def unknown_key_problem(code: str, detail: str) -> Problem:
    """The 401 problem for a caller whose key is none that opens the service."""
    return Problem(401, code, detail, headers={"WWW-Authenticate": 'Bearer realm="galatea"'})


def _note_use(context: Context, key: Key) -> None:
    if repository.used_recently(key):
        return
    try:
        with context.database.write() as session:
            repository.note_use(session, key.id)
    except DBAPIError as error:  # on a full disk what only reads goes on
        if not database_full(error):
            raise
        structlog.get_logger().warning("use_not_noted", reason=str(error.orig))
