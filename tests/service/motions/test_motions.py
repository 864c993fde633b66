"""The user's own motions beside the built-in ones: kept, checked in a job, named by characters' jobs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import pytest
from made_motion import bvh
from PIL import Image
from running import Running, eventually

from engine.character.options import BUILT_IN_MOTIONS
from engine.character.sample import sample_picture
from service.ids import new_id

WHIP = b"""HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT LeftUpLeg
  {
    OFFSET 0 -10 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 -40 0
    }
  }
}
MOTION
Frames: 1
Frame Time: 0.04
0 100 0 0 0 0 0 0 0
"""
"""Nobody's skeleton."""


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """A service with the engine's own kinds."""
    data = tmp_path_factory.mktemp("motions") / "data"
    running = Running(data, kinds="engine.kinds:KINDS", worker_kinds="motion,character")
    yield running
    running.stop()


def create(service: Running, name: str, content: bytes, **headers: str) -> dict[str, Any]:
    asked = {"data": {"name": name}, "files": {"file": ("m.bvh", content)}, "headers": headers}
    return service.client.post("/v1/motions", **asked).raise_for_status().json()


def checked(service: Running, name: str) -> dict[str, Any]:
    """The motion once the check has ended."""

    def motion() -> dict[str, Any]:
        return service.client.get(f"/v1/motions/{name}").raise_for_status().json()

    eventually(lambda: motion()["check_status"] != "pending", "the check ends", 300)
    return motion()


def told(answer: Any) -> tuple[int, str]:
    return answer.status_code, answer.json()["code"]


@pytest.fixture
def mine(service: Running) -> dict[str, Any]:
    """A motion that was checked. A test may have it checked again, or erase it."""
    if service.client.get("/v1/motions/swing").status_code == 404:
        created = create(service, "swing", bvh())
        assert (created["source"], created["check_status"]) == ("own", "pending")
    return checked(service, "swing")


@pytest.fixture
def photo(service: Running) -> str:
    file = BytesIO()
    Image.fromarray(sample_picture(300)).save(file, "PNG")
    return service.client.post("/v1/files", files={"file": ("p.png", file.getvalue())}).json()["id"]


def test_built_in_motions_come_first(service: Running, mine: dict[str, Any]) -> None:
    items = service.client.get("/v1/motions").json()["items"]
    assert [item["name"] for item in items[: len(BUILT_IN_MOTIONS)]] == list(BUILT_IN_MOTIONS)
    for item in items[: len(BUILT_IN_MOTIONS)]:
        assert item["source"] == "built-in" and item["title"] and item["seconds"] > 0.5
        assert item["loops"] is (item["name"] in ("idle", "walk", "run", "dance"))
        assert item == service.client.get(f"/v1/motions/{item['name']}").json()
    assert mine in items[len(BUILT_IN_MOTIONS) :]
    assert told(service.client.get("/v1/motions/walk/file")) == (404, "motion_without_file")


def test_what_is_in_a_motion_is_told(service: Running, mine: dict[str, Any]) -> None:
    assert (mine["check_status"], mine["error"], mine["missing"]) == ("ready", None, [])
    assert (mine["frames"], mine["fps"], mine["seconds"]) == (20, pytest.approx(30, abs=0.01), pytest.approx(0.633))
    assert mine["joints"][:2] == [{"name": "Hips", "parent": None}, {"name": "Spine", "parent": "Hips"}]
    assert len(mine["joints"]) == 21
    assert (mine["loops"], mine["clips"]) == (False, [])
    ours = {"LeftShoulder": "LeftCollar", "LeftArm": "LeftArm", "RightToeBase": "RightToe", "Spine2": "Chest"}
    assert ours.items() <= mine["mapping"].items()
    file = service.client.get(mine["url"])
    assert (file.content, file.headers["Content-Type"].split(";")[0]) == (bvh(), "text/x-bvh")
    assert service.client.get(mine["url"], headers={"Range": "bytes=0-8"}).content == b"HIERARCHY"


def test_the_animations_of_a_glb_are_told(service: Running, media: Callable[[str], Path]) -> None:
    create(service, "soldier", media("scans3d/body_soldier/soldier.glb").read_bytes())
    soldier = checked(service, "soldier")
    assert (soldier["clips"], soldier["loops"]) == (["Idle", "Run", "TPose", "Walk"], True)
    service.client.delete("/v1/motions/soldier").raise_for_status()


def test_an_uploaded_file_can_be_kept_by_its_id(service: Running, picture: bytes) -> None:
    file = service.client.post("/v1/files", files={"file": ("m.bvh", bvh(frames=3))}).json()["id"]
    made = service.client.post("/v1/motions", json={"name": "by-id", "file": file})
    assert (made.status_code, made.headers["Location"]) == (201, "/v1/motions/by-id")
    assert checked(service, "by-id")["frames"] == 3
    still = service.client.post("/v1/files", files={"file": picture}).json()["id"]
    for asked, status, code in (
        ({"name": "x", "file": new_id()}, 422, "unknown_file"),
        ({"name": "x", "file": still}, 415, "input_wrong_media"),
        ({"name": "x"}, 422, "invalid_request"),
        ({"name": "X", "file": file}, 422, "invalid_name"),
        ({"name": "by-id", "file": file}, 409, "name_taken"),
        ({"name": "walk", "file": file}, 409, "name_taken"),
    ):
        assert told(service.client.post("/v1/motions", json=asked)) == (status, code)
    assert service.client.delete("/v1/motions/by-id").status_code == 204
    assert service.client.get(f"/v1/files/{file}").status_code == 404


def test_a_motion_takes_another_name(service: Running, mine: dict[str, Any]) -> None:
    renamed = service.client.patch("/v1/motions/swing", json={"name": "sway"}).raise_for_status().json()
    assert renamed == {**mine, "name": "sway", "url": "/v1/motions/sway/file"}
    assert service.client.get(renamed["url"]).content == bvh()
    assert told(service.client.patch("/v1/motions/sway", json={"name": "walk"})) == (409, "name_taken")
    assert told(service.client.patch("/v1/motions/walk", json={"name": "sway"})) == (409, "motion_built_in")
    assert told(service.client.patch("/v1/motions/swing", json={"name": "swing"})) == (404, "motion_not_found")
    assert service.client.patch("/v1/motions/sway", json={"name": "swing"}).json() == mine


def test_a_motion_is_a_motion(service: Running, picture: bytes) -> None:
    answer = service.client.post("/v1/motions", data={"name": "still"}, files={"file": ("w.png", picture)})
    assert told(answer) == (415, "input_wrong_media")
    assert told(service.client.delete("/v1/motions/walk")) == (409, "motion_built_in")
    assert told(service.client.post("/v1/motions/walk/check")) == (409, "motion_built_in")
    for method, path in (("GET", ""), ("DELETE", ""), ("GET", "/file"), ("POST", "/check")):
        assert told(service.client.request(method, f"/v1/motions/nobody{path}")) == (404, "motion_not_found")


def test_what_is_wrong_is_told(service: Running) -> None:
    create(service, "whip", WHIP)
    whip = checked(service, "whip")
    assert (whip["check_status"], whip["error"]["code"]) == ("ready", "motion_not_humanoid")
    assert whip["mapping"] == {"Hips": "Hips", "LeftUpLeg": "LeftUpLeg"} and "LeftFoot" in whip["missing"]
    assert [joint["name"] for joint in whip["joints"]] == ["Hips", "LeftUpLeg"]
    create(service, "broken", WHIP[:80])
    broken = checked(service, "broken")
    assert (broken["check_status"], broken["error"]["code"]) == ("failed", "motion_truncated")
    assert broken["joints"] == [] and broken["frames"] is None
    for name in ("whip", "broken"):
        service.client.delete(f"/v1/motions/{name}").raise_for_status()


def test_another_file_mends_what_cannot_be_read(service: Running) -> None:
    create(service, "commas", bvh().replace(b"\n0 95 0", b"\n0 95,5 0"))
    commas = checked(service, "commas")
    assert commas["error"]["code"] == "motion_unreadable"
    job = service.job(commas["check_job"])
    assert job["error"]["correctable"] == ["motion"]
    revisions = f"/v1/jobs/{job['id']}/revisions"
    for corrections, code, pointer in (
        ({"motion": None}, "missing_input", "/corrections/motion"),
        ({"motion_joints": {"LeftHand": 5}}, "invalid_options", "/corrections/motion_joints/LeftHand"),
    ):
        answer = service.client.post(revisions, json={"corrections": corrections})
        assert told(answer) == (422, code)
        assert [error["pointer"] for error in answer.json()["errors"]] == [pointer]
    mended = service.client.post(revisions, files={"motion": ("m.bvh", bvh())}).raise_for_status().json()
    assert service.until(mended["id"], "succeeded", "failed", seconds=300)["error"] is None
    service.client.delete(f"/v1/jobs/{mended['id']}").raise_for_status()
    service.client.delete("/v1/motions/commas").raise_for_status()


def test_gltf_may_be_a_text(service: Running) -> None:
    create(service, "text", b'{"asset": {"version": "2.0"}, "nodes": [{"name": "cube"}]}')
    text = checked(service, "text")
    assert (text["content_type"], text["error"]["code"]) == ("model/gltf+json", "motion_without_animation")
    service.client.delete("/v1/motions/text").raise_for_status()


def test_half_a_character_in_a_name_does_no_harm(service: Running) -> None:
    document = b'{"asset":{"version":"2.0"},"animations":[],"nodes":[{"name":"\\ud800"}]}'
    padded = document + b" " * (-len(document) % 4)
    glb = b"glTF" + (2).to_bytes(4, "little") + (20 + len(padded)).to_bytes(4, "little")
    create(service, "odd", glb + len(padded).to_bytes(4, "little") + b"JSON" + padded)
    odd = checked(service, "odd")
    assert odd["check_status"] == "failed" and odd["error"]["code"].startswith("motion_")
    service.client.delete("/v1/motions/odd").raise_for_status()


def test_a_check_can_be_asked_for_again(service: Running, mine: dict[str, Any]) -> None:
    answer = service.client.post("/v1/motions/swing/check")
    assert answer.status_code == 202 and answer.json()["check_status"] in ("pending", "ready")
    again = checked(service, "swing")
    assert again["check_job"] != mine["check_job"]
    assert {**again, "check_job": None} == {**mine, "check_job": None}
    assert service.client.get(f"/v1/jobs/{mine['check_job']}").status_code == 404
    assert service.job(again["check_job"])["metadata"] == {"motion": "swing"}


def test_another_key_sees_nothing_of_it(service: Running, mine: dict[str, Any], photo: str) -> None:
    token = service.client.post("/v1/keys", json={"name": "other", "scopes": ["read", "submit"]}).json()["token"]
    headers = {"Authorization": f"Bearer {token}"}
    listed = service.client.get("/v1/motions", headers=headers).json()["items"]
    assert [item["name"] for item in listed] == list(BUILT_IN_MOTIONS)
    for method, path in (("GET", ""), ("GET", "/file"), ("POST", "/check"), ("DELETE", "")):
        answer = service.client.request(method, f"/v1/motions/swing{path}", headers=headers)
        assert told(answer) == (404, "motion_not_found")


def test_a_wrong_correction_is_shown_to_the_number(service: Running, photo: str) -> None:
    asked = {"kind": "character", "inputs": {"photo": photo}, "options": {"seconds": 1}}
    job = service.client.post("/v1/jobs", json=asked).raise_for_status().json()
    service.client.post(f"/v1/jobs/{job['id']}/cancel").raise_for_status()
    knee = {"corrections": {"joints": {"LeftKnee": ["left", 310]}}, "options": {"fps": 0}}
    answer = service.client.post(f"/v1/jobs/{job['id']}/revisions", json=knee)
    assert told(answer) == (422, "invalid_options")
    pointers = {error["pointer"] for error in answer.json()["errors"]}
    assert pointers == {"/corrections/joints/LeftKnee/0", "/options/fps"}
    service.client.delete(f"/v1/jobs/{job['id']}").raise_for_status()


def test_characters_move_by_ones_own_motion_until_both_are_gone(
    service: Running, mine: dict[str, Any], photo: str
) -> None:
    small = {"seconds": 1, "size": [96, 128], "triangles": 4000}
    options = {**small, "motion_joints": {"RightHand": None, "LeftShoulder": None}}
    asked = {"kind": "character", "inputs": {"photo": photo, "motion": "swing"}, "options": options}
    job = service.client.post("/v1/jobs", json=asked).raise_for_status().json()
    assert job["inputs"] == {"photo": photo, "motion": "swing"} and "motion" not in job["options"]
    job = service.until(job["id"], "succeeded", "failed", seconds=300)
    assert job["error"] is None
    report = service.client.get(job["artifacts"]["report.json"]["url"]).json()
    expected = {name: joint for name, joint in mine["mapping"].items() if name not in options["motion_joints"]}
    assert report["inputs"]["motion_joints"] == expected

    # a built-in one in its place takes the file back; and the other way round
    walking = {"corrections": {"motion": "bow"}, "options": {"motion_joints": None}}
    bow = service.client.post(f"/v1/jobs/{job['id']}/revisions", json=walking).raise_for_status().json()
    assert (bow["inputs"], bow["options"]) == ({"photo": photo}, {**small, "motion": "bow"})
    service.client.post(f"/v1/jobs/{bow['id']}/cancel")
    swing = {"corrections": {"motion": "swing", "motion_joints": {"LeftHand": "tail"}}}
    refused = service.client.post(f"/v1/jobs/{bow['id']}/revisions", json=swing).raise_for_status().json()
    assert refused["inputs"] == {"photo": photo, "motion": "swing"}
    refused = service.until(refused["id"], "succeeded", "failed", seconds=300)
    assert refused["error"]["code"] == "motion_joint_unknown" and "LeftArm" in refused["error"]["found"]["joints"]
    assert refused["error"]["correctable"] == ["motion_joints"]

    service.client.delete("/v1/motions/swing").raise_for_status()
    assert told(service.client.get("/v1/motions/swing")) == (404, "motion_not_found")
    answer = service.client.post("/v1/jobs", json=asked)
    assert told(answer) == (422, "unknown_motion") and answer.json()["errors"][0]["pointer"] == "/inputs/motion"
    again = {"corrections": {"motion_joints": {"LeftHand": None}}}
    revised = service.client.post(f"/v1/jobs/{job['id']}/revisions", json=again).raise_for_status().json()
    revised = service.until(revised["id"], "succeeded", "failed", seconds=300)
    assert revised["error"] is None, "the jobs keep the file"
    for one in (revised, refused, bow, job):
        service.client.delete(f"/v1/jobs/{one['id']}").raise_for_status()
    left = [path.read_bytes() for path in (service.data_dir / "storage" / "files").iterdir()]
    assert bvh() not in left, "and it goes with the last of them"
