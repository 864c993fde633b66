"""POST /live, GET and DELETE /live/{id}; the WebSockets /live/{id} and /live/{id}/view."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

from anyio.to_thread import run_sync
from fastapi import APIRouter, Depends, Request, WebSocket
from starlette.responses import Response
from starlette.websockets import WebSocketState
from websockets.frames import CloseCode

from service.auth.caller import Reader, Submitter, caller_of
from service.context import Context
from service.http.json_bodies import RequestModelRoute
from service.live.outlet import Outlet
from service.live.process import LiveOrder
from service.live.schemas import LiveIn, LiveOut
from service.live.session import LiveSession
from service.live.sessions import LiveSessions
from service.live.target import live_target
from service.problems import Problem, responses
from service.request_context import InContext

router = APIRouter(prefix="/live", tags=["live"], route_class=RequestModelRoute)

MAX_VIEWERS = 8
"""How many may look at a live portrait, the camera's own page among them."""
Feed = Callable[[bytes], None]
"""Takes a message of the camera."""
CLOSE_CODES = {
    "live_frame_too_large": CloseCode.MESSAGE_TOO_BIG,
    "live_frame_unreadable": CloseCode.UNSUPPORTED_DATA,
    "live_failed": CloseCode.INTERNAL_ERROR,
    "service_stopping": CloseCode.SERVICE_RESTART,
}
"""With which code of a WebSocket a session's end closes it; all others are in order."""


async def _sessions(request: Request) -> LiveSessions:
    sessions: LiveSessions = request.app.state.live
    return sessions


InSessions = Annotated[LiveSessions, Depends(_sessions)]


@router.post("", status_code=201, operation_id="create_live", responses=responses(404, 413, 422, 503))
async def create_live(
    requested: LiveIn, response: Response, caller: Submitter, context: InContext, sessions: InSessions
) -> LiveOut:
    """Begin a live portrait: a picture that follows a camera. Its frames are then sent by the WebSocket at `stream`."""
    sessions.require_room()
    key, options = await run_sync(live_target, context, caller.owner, requested, sessions.under_way(caller.owner))
    pixels = int(context.settings.live_frame_megapixels * 1_000_000)
    session = sessions.begin(caller.owner, key, LiveOrder(Path("target"), options, pixels))
    response.headers["Location"] = f"/v1/live/{session.id}"
    return LiveOut.of(session)


@router.get("/{live_id}", operation_id="get_live", responses=responses(404))
async def get_live(live_id: str, caller: Reader, sessions: InSessions) -> LiveOut:
    """How a live portrait is; for half a minute after its end, why it ended."""
    return LiveOut.of(sessions.find(live_id, caller.owner))


@router.delete("/{live_id}", status_code=204, operation_id="end_live", responses=responses(404))
async def end_live(live_id: str, caller: Submitter, sessions: InSessions) -> None:
    """End a live portrait."""
    sessions.find(live_id, caller.owner).end("live_ended")


@router.websocket("/{live_id}")
async def stream(websocket: WebSocket, live_id: str) -> None:
    """The camera's frames in, the portrait's out."""
    context: Context = websocket.app.state.context
    sessions: LiveSessions = websocket.app.state.live
    try:
        caller = await run_sync(caller_of, websocket, context)
        caller.require("submit")
        session = sessions.find(live_id, caller.owner)
        if session.has_camera:
            raise Problem(409, "live_has_camera", "Another camera feeds this live portrait: begin one of your own.")
    except Problem as problem:
        await problem.response()(websocket.scope, websocket.receive, websocket.send)
        return
    session.has_camera = True
    await websocket.accept()
    try:
        await _show(websocket, session, session.feed)
    finally:
        session.end("live_closed")


@router.websocket("/{live_id}/view")
async def view(websocket: WebSocket, live_id: str, token: str = "") -> None:
    """The portrait's frames, for those who look on."""
    sessions: LiveSessions = websocket.app.state.live
    try:
        session = sessions.find_to_view(live_id, token)
        if session.viewers >= MAX_VIEWERS:
            raise Problem(503, "live_viewers", f"{MAX_VIEWERS} look at this live portrait already, the most that may.")
    except Problem as problem:
        await problem.response()(websocket.scope, websocket.receive, websocket.send)
        return
    await websocket.accept()
    await _show(websocket, session, None)


async def _show(websocket: WebSocket, session: LiveSession, camera: Feed | None) -> None:
    """Send what there is to be seen until the session ends or the other side has gone; what it sends goes to `camera`."""
    outlet = session.look()
    reading = asyncio.ensure_future(_read(websocket, session, camera))
    sending = asyncio.ensure_future(_send(websocket, outlet))
    try:
        await asyncio.wait((reading, sending), return_when=asyncio.FIRST_COMPLETED)
    finally:
        session.look_away(outlet)
        for task in (reading, sending):
            task.cancel()
        await asyncio.gather(reading, sending, return_exceptions=True)


async def _send(websocket: WebSocket, outlet: Outlet) -> None:
    """Send frames and events; after the last one, close."""
    while True:
        message = await outlet.take()
        if isinstance(message, bytes):
            await websocket.send_bytes(message)
            continue
        await websocket.send_text(json.dumps(message))
        if message["event"] == "ended":
            await websocket.close(CLOSE_CODES.get(message["code"], CloseCode.NORMAL_CLOSURE), message["code"])
            return


async def _read(websocket: WebSocket, session: LiveSession, camera: Feed | None) -> None:
    """Take in what the other side sends."""
    while websocket.client_state is WebSocketState.CONNECTED:
        message = await websocket.receive()
        if message["type"] == "websocket.disconnect":
            return
        data, text = message.get("bytes"), message.get("text")
        if camera is not None and data is not None:
            camera(data)
        elif camera is not None and text is not None:
            session.command(text)
