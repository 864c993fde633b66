"""/motions: the built-in motions and the user's own BVH and glTF files; and their files."""

from __future__ import annotations

from fastapi import Request
from starlette.responses import Response

from service.auth.caller import Reader
from service.http.delivery import DELIVERED_IN_PARTS, deliver, stored_file
from service.keeping.endpoints import Endpoints, library_router
from service.motions import service
from service.motions.schemas import MotionList, MotionOut
from service.request_context import InContext

router = library_router(
    service.PRESENTED_MOTIONS,
    Endpoints(
        item=MotionOut,
        listed=MotionList,
        media_types="text/x-bvh, model/gltf-binary, model/gltf+json",
        inspection="check",
        inspect="check",
        list_says="The motions that a character's job can name: the built-in ones, then the user's own.",
        keep_says="Keep a motion under a name. A job checks then what is in it.",
        inspect_says="Check one of the user's own motions again. A new motion is checked by itself.",
        file_is="file",
    ),
)


@stored_file("/{name}/file", router, "get_motion_file", DELIVERED_IN_PARTS)
def get_motion_file(name: str, request: Request, caller: Reader, context: InContext) -> Response:
    """The file of one of the user's own motions: whole, or the ranges asked for."""
    stored = service.stored(context, caller.owner, name)
    return deliver(stored, context.storage, request)
