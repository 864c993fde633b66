"""GET /jobs/{id}/artifacts/{name}."""

from __future__ import annotations

from fastapi import APIRouter, Request
from starlette.responses import Response

from service.artifacts import repository
from service.artifacts.delivery import deliver
from service.context import InContext
from service.problems import Problem, responses

router = APIRouter(prefix="/jobs", tags=["jobs"])


@router.head("/{job_id}/artifacts/{name}", include_in_schema=False)
@router.get(
    "/{job_id}/artifacts/{name}",
    operation_id="get_artifact",
    response_class=Response,
    responses={206: {"description": "The asked parts"}, 304: {"description": "Not modified"}, **responses(404, 416)},
)
def get_artifact(job_id: str, name: str, request: Request, context: InContext) -> Response:
    """An artifact: whole, or the ranges asked for; unchanged ones are answered with 304."""
    with context.database.read() as session:
        artifact = repository.get(session, job_id, name)
    if artifact is None:
        raise Problem(404, "artifact_not_found", "The job has no artifact of this name (yet).")
    return deliver(artifact.stored, context.storage, request.headers, request.method == "HEAD")
