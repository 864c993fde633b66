"""GET, POST, PATCH and DELETE /motions: the built-in motions and the user's own BVH and glTF files."""

from __future__ import annotations

from fastapi import APIRouter, Request
from starlette.responses import Response

from service.artifacts.delivery import DELIVERED_IN_PARTS, deliver
from service.asked import AskedRoute
from service.auth.caller import Reader, Submitter
from service.context import InContext
from service.kept import endpoints as kept
from service.kept import service as keeping
from service.kept.request import KeptChange, body
from service.kept.shelves import MOTIONS
from service.motions import service
from service.motions.schemas import MotionList, MotionOut
from service.problems import responses

router = APIRouter(prefix="/motions", tags=["motions"], route_class=AskedRoute)


@router.get("", operation_id="list_motions")
def list_motions(caller: Reader, context: InContext) -> MotionList:
    """The motions that a character's job can name: the built-in ones, then the user's own."""
    return MotionList(items=service.all_motions(context, caller.owner))


@router.post(
    "",
    status_code=201,
    operation_id="create_motion",
    openapi_extra=body("text/x-bvh, model/gltf-binary, model/gltf+json"),
    responses=responses(409, 413, 415, 422, 507),
)
async def create_motion(request: Request, response: Response, caller: Submitter, context: InContext) -> MotionOut:
    """Keep a motion under a name. A job checks then what is in it."""
    return await kept.create(MOTIONS, service.one_motion, request, response, caller, context)


@router.get("/{name}", operation_id="get_motion", responses=responses(404))
def get_motion(name: str, caller: Reader, context: InContext) -> MotionOut:
    """What is known of a motion."""
    return service.one_motion(context, caller.owner, name)


@router.post(
    "/{name}/check",
    status_code=202,
    operation_id="check_motion",
    responses=responses(404, 409, 422, 507),
)
def check_motion(name: str, caller: Submitter, context: InContext) -> MotionOut:
    """Check one of the user's own motions again. A new motion is checked by itself."""
    return kept.look_again(MOTIONS, service.one_motion, name, caller, context)


@router.patch("/{name}", operation_id="rename_motion", responses=responses(404, 409, 422))
def rename_motion(name: str, asked: KeptChange, caller: Submitter, context: InContext) -> MotionOut:
    """Give one of the user's own motions another name. Jobs that use it stay as they are."""
    return kept.rename(MOTIONS, service.one_motion, name, asked.name, caller, context)


@router.delete("/{name}", status_code=204, operation_id="delete_motion", responses=responses(404, 409))
def delete_motion(name: str, caller: Submitter, context: InContext) -> None:
    """Erase one of the user's own motions. Jobs that use it keep its file until they are deleted."""
    keeping.delete(context, MOTIONS, caller.owner, name)


@router.head("/{name}/file", include_in_schema=False)
@router.get(
    "/{name}/file",
    operation_id="get_motion_file",
    response_class=Response,
    responses=DELIVERED_IN_PARTS,
)
def get_motion_file(name: str, request: Request, caller: Reader, context: InContext) -> Response:
    """The file of one of the user's own motions: whole, or the ranges asked for."""
    stored = service.stored(context, caller.owner, name)
    return deliver(stored, context.storage, request.headers, request.method == "HEAD")
