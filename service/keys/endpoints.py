"""GET /key, GET, POST and DELETE /keys, POST and DELETE /session."""

from __future__ import annotations

from fastapi import APIRouter, Request
from starlette.responses import Response

from service.auth import repository
from service.auth.caller import Admin, Reader, unknown_key_problem
from service.auth.sessions import SESSION_COOKIE, SESSION_SECONDS, new_session
from service.auth.wrong_keys import count_wrong_key
from service.clock import now
from service.http.json_bodies import RequestModelRoute
from service.keys import service
from service.keys.schemas import KeyIn, KeyList, KeyOut, NewKeyOut, OwnKeyOut, SessionIn
from service.problems import Problem, responses
from service.request_context import InContext
from service.tables.keys import Key

router = APIRouter(tags=["keys"], route_class=RequestModelRoute)


@router.get("/key", operation_id="get_own_key")
def get_own_key(caller: Reader, context: InContext) -> OwnKeyOut:
    """The key that the request came with: what it may do, its limits, and how much of them is used."""
    with context.database.read() as session:
        key = _there(repository.get(session, caller.owner))
        under_way = repository.jobs_under_way(session, key.id)
        stored = repository.stored_bytes(session, key.id)
    return OwnKeyOut.of(key, context.settings, under_way, stored)


@router.get("/keys", operation_id="list_keys")
def list_keys(caller: Admin, context: InContext) -> KeyList:
    """All keys, revoked ones too, without their tokens."""
    with context.database.read() as session:
        return KeyList(items=[KeyOut.of(key) for key in repository.with_tokens(session)])


@router.post("/keys", status_code=201, operation_id="create_key", responses=responses(422))
def create_key(requested: KeyIn, caller: Admin, response: Response, context: InContext) -> NewKeyOut:
    """Make a key. Its token is in this answer and nowhere else."""
    with context.database.write() as session:
        key, token = service.create(session, requested)
    response.headers["Location"] = f"/v1/keys/{key.id}"
    response.headers["Cache-Control"] = "no-store"
    return NewKeyOut(token=token, **KeyOut.of(key).model_dump())


@router.get("/keys/{key_id}", operation_id="get_key", responses=responses(404))
def get_key(key_id: str, caller: Admin, context: InContext) -> KeyOut:
    """A key without its token."""
    with context.database.read() as session:
        return KeyOut.of(_there(repository.get(session, key_id)))


@router.delete("/keys/{key_id}", status_code=204, operation_id="revoke_key", responses=responses(404))
def revoke_key(key_id: str, caller: Admin, context: InContext, erase: bool = False) -> None:
    """Revoke a key; with `erase`, also erase all that belongs to it."""
    with context.database.write() as session:
        service.revoke(session, key_id)
    if erase:
        service.erase_all(context, key_id)


@router.post("/session", status_code=204, operation_id="open_session", responses=responses(401, 422))
def open_session(requested: SessionIn, request: Request, response: Response, context: InContext) -> None:
    """Give a key once; a cookie that scripts cannot read stands for it then (for the web page)."""
    with context.database.read() as session:
        key = repository.of_token(session, requested.key)
    if key is None or not repository.usable(key, now()):
        count_wrong_key(context, request)
        raise unknown_key_problem("key_unknown", "There is no such key: it was revoked, has expired, or never was.")
    response.set_cookie(
        SESSION_COOKIE,
        new_session(key),
        max_age=SESSION_SECONDS,
        path="/",
        secure=request.headers.get("x-forwarded-proto", request.url.scheme) == "https",
        httponly=True,
        samesite="strict",
    )


@router.delete("/session", status_code=204, operation_id="close_session")
def close_session(response: Response) -> None:
    """Forget the key in this browser."""
    response.delete_cookie(SESSION_COOKIE, path="/", httponly=True, samesite="strict")


def _there(key: Key | None) -> Key:
    if key is None:
        raise Problem(404, "key_not_found", "There is no such key.")
    return key
