"""Live portraits over HTTP and WebSockets, against a service that runs."""

from __future__ import annotations

import json
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import cv2
import httpx
import pytest
from PIL import Image
from running import Running, eventually
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection
from websockets.sync.client import connect as open_websocket

from engine.export.synthetic import XMP_PACKET
from engine.media.video import read_video
from engine.performances import video as performance


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """A service that makes one live portrait at once."""
    data = tmp_path_factory.mktemp("live") / "data"
    with Running(data, worker="false", live_streams=1, live_frame_mb=0.5) as running:
        yield running


@pytest.fixture(scope="module")
def face() -> bytes:
    """A frame of a built-in performance, whose face is at rest: a JPEG."""
    rgb = next(iter(read_video(performance("idle")))).rgb
    done, jpeg = cv2.imencode(".jpg", cv2.cvtColor(cv2.resize(rgb, (320, 320)), cv2.COLOR_RGB2BGR))
    assert done
    return jpeg.tobytes()


@pytest.fixture
def target(service: Running, face: bytes) -> str:
    sent = service.client.post("/v1/files", files={"file": ("face.jpg", face)})
    return str(sent.raise_for_status().json()["id"])


@pytest.fixture
def live(service: Running, target: str) -> Iterator[dict[str, Any]]:
    made = service.client.post("/v1/live", json={"image": target, "options": {"longest_side": 128}})
    yield made.raise_for_status().json()
    service.client.delete(f"/v1/live/{made.json()['id']}")
    eventually(lambda: not service.processes("worker.live.child"), "its process has ended")


def connect(service: Running, path: str, **headers: str) -> ClientConnection:
    given = {name.replace("_", "-"): value for name, value in headers.items()}
    address = str(service.client.base_url).replace("http", "ws", 1).rstrip("/") + path
    return open_websocket(address, additional_headers=given, compression=None, open_timeout=120, proxy=None)


def refused(service: Running, path: str, **headers: str) -> tuple[int, str]:
    with pytest.raises(InvalidStatus) as answer:
        connect(service, path, **headers)
    return answer.value.response.status_code, json.loads(answer.value.response.body)["code"]


def events(line: ClientConnection, until: str) -> list[dict[str, Any]]:
    """The events up to one of this name."""
    found: list[dict[str, Any]] = []
    while not found or found[-1]["event"] != until:
        message = line.recv(120)
        if isinstance(message, str):
            found.append(json.loads(message))
    return found


def test_a_picture_follows_the_camera_and_others_look_on(service: Running, live: dict[str, Any], face: bytes) -> None:
    with connect(service, live["stream"]) as camera, connect(service, live["view"]) as viewer:
        assert events(camera, "calibrating")[0]["event"] == "preparing"
        number, shown = 0, {}
        while "ready" not in shown:
            number += 1
            camera.send(number.to_bytes(4, "big") + face)
            message = camera.recv(120)
            while isinstance(message, str):
                shown[json.loads(message)["event"]] = True
                message = camera.recv(120)
        assert isinstance(message, bytes)
        assert message[4:6] == b"\xff\xd8" and XMP_PACKET in message
        assert int.from_bytes(message[:4], "big") <= number
        assert Image.open(BytesIO(message[4:])).size == (128, 128)
        assert events(viewer, "ready")
        assert isinstance(viewer.recv(120), bytes)
        assert service.client.get(f"/v1/live/{live['id']}").json()["status"] == "live"
        camera.send(b"\0\0\0\1 no picture")
        assert events(camera, "ended")[-1]["code"] == "live_frame_unreadable"
        with pytest.raises(ConnectionClosed) as closed:
            camera.recv(120)
        assert closed.value.rcvd is not None and closed.value.rcvd.code == 1003
    assert service.client.get(f"/v1/live/{live['id']}").json()["code"] == "live_frame_unreadable"


def test_one_is_made_at_once_and_when_its_camera_has_gone_there_is_room(
    service: Running, live: dict[str, Any], target: str
) -> None:
    more = service.client.post("/v1/live", json={"image": target})
    assert (more.status_code, more.json()["code"]) == (503, "live_busy") and "Retry-After" in more.headers
    with connect(service, live["stream"]):
        assert refused(service, live["stream"]) == (409, "live_has_camera")
    eventually(lambda: service.client.get(f"/v1/live/{live['id']}").json()["code"] == "live_closed", "it has ended")
    eventually(lambda: not service.processes("worker.live.child"), "its process has ended")


def test_who_may_not_is_refused_at_the_handshake(service: Running, live: dict[str, Any]) -> None:
    assert refused(service, live["stream"], Origin="https://elsewhere.example") == (403, "origin_not_allowed")
    assert refused(service, live["stream"], Authorization="Bearer wrong") == (401, "key_unknown")
    assert refused(service, live["stream"], Sec_WebSocket_Version="8") == (426, "websocket_version")
    assert refused(service, "/v1/live/00000000-0000-7000-8000-000000000000") == (404, "live_not_found")
    assert refused(service, f"/v1/live/{live['id']}/view?token=guessed") == (404, "live_not_found")
    assert refused(service, "/v1/kinds")[0] in (403, 404)


def test_a_frame_that_is_too_large_ends_it(service: Running, live: dict[str, Any]) -> None:
    with connect(service, live["stream"]) as camera:
        camera.send(bytes(500_001))
        assert events(camera, "ended")[-1]["code"] == "live_frame_too_large"


def test_what_the_service_does_not_know_ends_it(service: Running, live: dict[str, Any]) -> None:
    with connect(service, live["stream"]) as camera:
        camera.send('{"command": "fly"}')
        assert events(camera, "ended")[-1]["code"] == "live_message_unknown"


def test_a_picture_without_a_face_ends_it_with_what_a_job_would_say(service: Running) -> None:
    plain = BytesIO()
    Image.new("RGB", (96, 96), (120, 130, 140)).save(plain, "PNG")
    file = service.client.post("/v1/files", files={"file": ("plain.png", plain.getvalue())}).json()
    live = service.client.post("/v1/live", json={"image": file["id"]}).raise_for_status().json()
    with connect(service, live["stream"]) as camera:
        assert events(camera, "ended")[-1]["code"] == "no_face"


@pytest.mark.parametrize(
    ("body", "status", "code"),
    [
        ({}, 422, "live_target_missing"),
        ({"image": "1", "job": "2"}, 422, "live_target_missing"),
        ({"image": "00000000-0000-7000-8000-000000000000"}, 404, "file_not_found"),
        ({"job": "00000000-0000-7000-8000-000000000000"}, 404, "job_not_found"),
    ],
)
def test_what_cannot_follow_a_camera_is_refused(service: Running, body: dict[str, Any], status: int, code: str) -> None:
    answer = service.client.post("/v1/live", json=body)
    assert (answer.status_code, answer.json()["code"]) == (status, code)


def test_an_option_that_there_is_not_is_refused(service: Running, target: str) -> None:
    answer = service.client.post("/v1/live", json={"image": target, "options": {"longest_side": 5000}})
    assert (answer.status_code, answer.json()["code"]) == (422, "invalid_options")


def test_where_keys_are_asked_for_the_handshake_asks_for_one(tmp_path: Path, face: bytes) -> None:
    data = tmp_path / "data"
    with Running(data, worker="false") as running:
        made = running.client.post("/v1/keys", json={"name": "camera"}).raise_for_status().json()
        running.stop()
        running.settings["require_keys"] = True
        running.start()
        with httpx.Client(
            base_url=running.client.base_url, headers={"Authorization": f"Bearer {made['token']}"}
        ) as own:
            file = own.post("/v1/files", files={"file": ("face.jpg", face)}).raise_for_status().json()
            live = own.post("/v1/live", json={"image": file["id"]}).raise_for_status().json()
        assert refused(running, live["stream"]) == (401, "key_missing")
        with connect(running, live["stream"], Authorization=f"Bearer {made['token']}") as camera:
            assert isinstance(camera.recv(120), str)


def test_a_message_in_parts_is_one_and_a_text_that_is_none_ends_it(service: Running, live: dict[str, Any]) -> None:
    with connect(service, live["stream"]) as camera:

        def parts() -> Iterator[str]:
            yield '{"comm'
            camera.ping(b"?")  # what is no part of a message may come between its parts
            yield 'and": "fl'
            yield 'y"}'

        camera.send(parts())
        assert events(camera, "ended")[-1]["code"] == "live_message_unknown"


def test_what_breaks_the_protocol_is_told_by_its_code(service: Running, live: dict[str, Any]) -> None:
    with connect(service, live["view"]) as viewer:
        viewer.send(b"\xff\xfe", text=True)
        with pytest.raises(ConnectionClosed) as closed:
            while True:
                viewer.recv(120)
        assert closed.value.rcvd is not None and closed.value.rcvd.code == 1007
