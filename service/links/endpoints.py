"""Public links: POST and GET /jobs/{id}/links, DELETE /links/{id}; GET /public/{token} for everybody."""

from __future__ import annotations

import secrets
from datetime import timedelta

from fastapi import APIRouter, Request
from sqlalchemy.orm import Session
from starlette.responses import Response

from service.artifacts import repository as artifacts
from service.artifacts.delivery import DELIVERED_IN_PARTS, deliver
from service.asked import AskedRoute
from service.auth.caller import Reader, Submitter
from service.clock import now
from service.context import InContext
from service.ids import new_id
from service.jobs import repository as jobs
from service.jobs.service import found
from service.links import repository
from service.links.models import PublicLink
from service.links.schemas import LinkIn, LinkList, LinkOut, SharedOut, opens
from service.problems import Problem, responses

router = APIRouter(tags=["links"], route_class=AskedRoute)

FROM_ANYWHERE = {
    "Access-Control-Allow-Origin": "*",
    "Access-Control-Expose-Headers": "Content-Length, Content-Range, ETag",
    "Cross-Origin-Resource-Policy": "cross-origin",
}
"""Pages of any origin may show what is public."""


@router.post("/jobs/{job_id}/links", status_code=201, operation_id="create_link", responses=responses(404, 422))
def create_link(job_id: str, asked: LinkIn, caller: Submitter, response: Response, context: InContext) -> LinkOut:
    """Make the results of a job public, under an address that cannot be guessed, for a while or until it is revoked."""
    moment = now()
    link = PublicLink(
        id=new_id(),
        token=secrets.token_urlsafe(24),
        owner=caller.owner,
        job_id=job_id,
        names=asked.artifacts,
        created_at=moment,
        expires_at=None if asked.expires_in_hours is None else moment + timedelta(hours=asked.expires_in_hours),
    )
    with context.database.write() as session:
        found(session, caller.owner, job_id)
        session.add(link)
    response.headers["Location"] = f"/v1/links/{link.id}"
    return LinkOut.of(link)


@router.get("/jobs/{job_id}/links", operation_id="list_links", responses=responses(404))
def list_links(job_id: str, caller: Reader, context: InContext) -> LinkList:
    """The public links to a job."""
    with context.database.read() as session:
        found(session, caller.owner, job_id)
        return LinkList(items=[LinkOut.of(link) for link in repository.of_job(session, job_id)])


@router.delete("/links/{link_id}", status_code=204, operation_id="revoke_link", responses=responses(404))
def revoke_link(link_id: str, caller: Submitter, context: InContext) -> None:
    """Take a public link back."""
    with context.database.write() as session:
        if not repository.revoke(session, caller.owner, link_id):
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
    response.headers.update({**FROM_ANYWHERE, "Cache-Control": "no-cache"})
    return SharedOut.of(link, job.kind, job.finished_at, made)


@router.head("/public/{token}/{name}", include_in_schema=False)
@router.get(
    "/public/{token}/{name}",
    operation_id="get_shared_artifact",
    response_class=Response,
    responses=DELIVERED_IN_PARTS,
)
def get_shared_artifact(token: str, name: str, request: Request, context: InContext) -> Response:
    """An artifact that a public link opens: whole, or the ranges asked for."""
    with context.database.read() as session:
        link = _good(session, token)
        artifact = artifacts.get(session, link.job_id, name) if opens(link, name) else None
    if artifact is None:
        raise Problem(404, "artifact_not_found", "The link opens no artifact of this name.", headers=FROM_ANYWHERE)
    response = deliver(artifact.stored, context.storage, request.headers, request.method == "HEAD")
    response.headers.update(FROM_ANYWHERE)
    return response


def _good(session: Session, token: str) -> PublicLink:
    link = repository.good(session, token)
    if link is None:
        raise _gone()
    return link


def _gone() -> Problem:
    detail = "There is nothing at this link: it was revoked, has expired, or never was."
    return Problem(404, "link_not_found", detail, headers=FROM_ANYWHERE)
