"""GET /kinds."""

from __future__ import annotations

from fastapi import APIRouter

from service.auth.caller import Reader
from service.kinds.schemas import KindList, KindOut
from service.request_context import InContext

router = APIRouter(prefix="/kinds", tags=["kinds"])


@router.get("", operation_id="list_kinds")
def list_kinds(caller: Reader, context: InContext) -> KindList:
    """The job kinds, with the JSON schemas of their inputs and options."""
    return KindList(items=[KindOut.of(kind, context.settings) for kind in context.kinds.values()])
