"""Live portraits as the API takes and shows them."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, JsonValue

from service.http.request_models import REQUEST_MODEL
from service.live.session import LiveSession


class LiveIn(BaseModel):
    """Which picture is to follow the camera: one of `image` and `job`."""

    model_config = REQUEST_MODEL

    image: str | None = None
    """The id of an uploaded picture."""
    job: str | None = None
    """The id of a portrait job, whose picture and framing are taken."""
    options: dict[str, JsonValue] = {}
    """`longest_side` (512, at most 768), and those of a portrait job: `crop`, `face_index`, `landmarks`, `strength`, `follow`,
    `head_3d`."""


class LiveOut(BaseModel):
    """A live portrait."""

    id: str
    status: Literal["preparing", "calibrating", "live", "ended"]
    stream: str
    """The address of the WebSocket that takes the camera's frames."""
    view: str
    """The address of one that shows the portrait to others. It holds a secret: whoever knows it may look."""
    code: str | None
    """Why it has ended."""
    detail: str | None

    @classmethod
    def of(cls, session: LiveSession) -> LiveOut:
        at, ended = f"/v1/live/{session.id}", session.ended or {}
        return cls.model_validate(
            {
                "id": session.id,
                "status": session.status,
                "stream": at,
                "view": f"{at}/view?token={session.view_token}",
                "code": ended.get("code"),
                "detail": ended.get("detail"),
            }
        )
