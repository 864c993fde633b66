"""Public links: POST and GET /jobs/{id}/links, GET /links, DELETE /links/{id}; GET /public/{token} for everybody."""

from __future__ import annotations

import secrets
from datetime import timedelta
from typing import Annotated

from fastapi import APIRouter, Query, Request
from sqlalchemy.orm import Session
from starlette.responses import Response

from service.auth.caller import Caller, InCaller, Reader, Scope, Submitter
from service.auth.tokens import digest
from service.clock import now
from service.http.delivery import DELIVERED_IN_PARTS, deliver, stored_file
from service.http.json_bodies import RequestModelRoute
from service.ids import LIKE_AN_ID, is_id, new_id
from service.job_records import artifacts, jobs
from service.job_records.owned import own_job
from service.links import repository
from service.links.schemas import LinkIn, LinkList, LinkOut, LinkPage, SharedOut, opens_artifact
from service.problems import Problem, responses
from service.request_context import InContext
from service.tables.links import PublicLink

router = APIRouter(tags=["links"], route_class=RequestModelRoute)

LINK_HINT_CHARACTERS = 6

CROSS_ORIGIN_HEADERS = {
    "Access-Control-Allow-Origin": "*",
    "Access-Control-Expose-Headers": "Content-Length, Content-Range, ETag",
    "Cross-Origin-Resource-Policy": "cross-origin",
}
"""Pages of any origin may show what is public."""


@router.post("/jobs/{job_id}/links", status_code=201, operation_id="create_link", responses=responses(404, 422))
def create_link(job_id: str, requested: LinkIn, caller: Submitter, response: Response, context: InContext) -> LinkOut:
    """Make the results of a job public, under an address that cannot be guessed, for a while or until it is revoked."""
    moment, token = now(), secrets.token_urlsafe(24)
    hours = requested.expires_in_hours
    if "expires_in_hours" not in requested.model_fields_set:
        hours = context.settings.public_link_hours or None
    link = PublicLink(
        id=new_id(),
        token_hash=digest(token),
        hint=token[:LINK_HINT_CHARACTERS],
        owner=caller.owner,
        job_id=job_id,
        names=requested.artifacts,
        created_at=moment,
        expires_at=None if hours is None else moment + timedelta(hours=hours),
    )
    with context.database.write() as session:
        own_job(session, caller.owner, job_id)
        session.add(link)
    response.headers["Location"] = f"/v1/links/{link.id}"
    response.headers["Cache-Control"] = "no-store"
    return LinkOut.of(link, token)


@router.get("/jobs/{job_id}/links", operation_id="list_links", responses=responses(404))
def list_links(job_id: str, caller: Reader, context: InContext) -> LinkList:
    """The public links to a job."""
    with context.database.read() as session:
        own_job(session, caller.owner, job_id)
        return LinkList(items=[LinkOut.of(link) for link in repository.of_job(session, job_id)])


@router.get("/links", operation_id="list_all_links", responses=responses(422))
def list_all_links(
    request: Request,
    response: Response,
    caller: InCaller,
    context: InContext,
    limit: Annotated[int, Query(ge=1, le=200)] = 50,
    cursor: Annotated[str | None, Query(json_schema_extra=LIKE_AN_ID)] = None,
) -> LinkPage:
    """The public links to all jobs, newest first: one's own, or with the scope `admin` those of every key."""
    if cursor is not None and not is_id(cursor):
        raise Problem(422, "invalid_cursor", "The cursor is not one that a list gave: begin again without it.")
    with context.database.read() as session:
        links = repository.page(session, _whose(caller, "read"), limit + 1, cursor)
    next_cursor = links[limit - 1].id if len(links) > limit else None
    if next_cursor is not None:
        following = request.url.include_query_params(cursor=next_cursor)
        response.headers["Link"] = f'<{following.path}?{following.query}>; rel="next"'
    return LinkPage(items=[LinkOut.of(link) for link in links[:limit]], next_cursor=next_cursor)


@router.delete("/links/{link_id}", status_code=204, operation_id="revoke_link", responses=responses(404))
def revoke_link(link_id: str, caller: InCaller, context: InContext) -> None:
    """Take a public link back: one's own, or with the scope `admin` anybody's."""
    with context.database.write() as session:
        if not repository.revoke(session, _whose(caller, "submit"), link_id):
            raise Problem(404, "link_not_found", "There is no such link: it was revoked, or it never was.")


@router.get("/public/{token}", operation_id="get_shared", responses=responses(404))
def get_shared(token: str, response: Response, context: InContext) -> SharedOut:
    """What a public link opens."""
    with context.database.read() as session:
        link = _good(session, token)
        job = jobs.get(session, link.job_id)
        if job is None:
            raise _gone()
        made = artifacts.of_jobs(session, [job.id])[job.id]
    response.headers.update({**CROSS_ORIGIN_HEADERS, "Cache-Control": "no-cache"})
    return SharedOut.of(link, token, job, made)


@stored_file("/public/{token}/{name}", router, "get_shared_artifact", DELIVERED_IN_PARTS)
def get_shared_artifact(token: str, name: str, request: Request, context: InContext) -> Response:
    """An artifact that a public link opens: whole, or the ranges asked for."""
    with context.database.read() as session:
        link = _good(session, token)
        artifact = artifacts.get(session, link.job_id, name) if opens_artifact(link, name) else None
    if artifact is None:
        raise Problem(
            404, "artifact_not_found", "The link opens no artifact of this name.", headers=CROSS_ORIGIN_HEADERS
        )
    response = deliver(artifact.stored, context.storage, request)
    response.headers.update(CROSS_ORIGIN_HEADERS)
    return response


def _whose(caller: Caller, scope: Scope) -> str | None:
    """Whose links a caller has to do with: everybody's (None) where it manages keys, or its own. Raises a 403 problem."""
    if "admin" in caller.scopes:
        return None
    caller.require(scope)
    return caller.owner


def _good(session: Session, token: str) -> PublicLink:
    link = repository.valid_link(session, token)
    if link is None:
        raise _gone()
    return link


def _gone() -> Problem:
    detail = "There is nothing at this link: it was revoked, has expired, or never was."
    return Problem(404, "link_not_found", detail, headers=CROSS_ORIGIN_HEADERS)
