"""Jobs that begin with what an earlier job of the same kind has made."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import httpx
import pytest
from running import Running

from service.ids import new_id

PICTURE_INPUT = "/inputs/earlier"


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    folder = tmp_path_factory.mktemp("earlier") / "data"
    with Running(folder, kinds="tiny_kind:KIND,tiny_kind:FOLLOWING,tiny_kind:TOGETHER") as running:
        yield running


def submit(service: Running, inputs: dict[str, str], kind: str = "following", **options: Any) -> httpx.Response:
    asked = {"kind": kind, "inputs": inputs, "options": options}
    return service.client.post("/v1/jobs", json=asked, headers={"Prefer": "wait=30"})


def uploaded(service: Running, picture: bytes) -> str:
    return str(service.client.post("/v1/files", files={"file": picture}).raise_for_status().json()["id"])


def refused(response: httpx.Response) -> tuple[int, str, str]:
    problem = response.json()
    return response.status_code, problem["code"], problem["errors"][0]["pointer"]


def measured(service: Running, job: dict[str, Any]) -> float:
    return float(service.client.get(job["artifacts"]["report.json"]["url"]).json()["quality"]["mean"])


@pytest.fixture
def done(service: Running, picture: bytes) -> dict[str, Any]:
    job = submit(service, {"image": uploaded(service, picture)}).json()
    assert job["status"] == "succeeded", job
    return dict(job)


def test_a_job_takes_what_an_earlier_one_has_left(service: Running, done: dict[str, Any]) -> None:
    next_one = submit(service, {"earlier": done["id"]}).json()
    assert next_one["status"] == "succeeded" and next_one["inputs"] == {"earlier": done["id"]}
    assert measured(service, next_one) == measured(service, done)
    third = submit(service, {"earlier": next_one["id"]}).json()
    assert measured(service, third) == measured(service, done)


def test_a_file_may_be_given_all_the_same(service: Running, picture: bytes, done: dict[str, Any]) -> None:
    job = submit(service, {"earlier": uploaded(service, picture)}).json()
    assert measured(service, job) == measured(service, done)


def test_one_of_both_inputs_is_needed(service: Running) -> None:
    assert refused(submit(service, {})) == (422, "missing_input", "/inputs/image")
    inputs = {one["name"]: one for one in service.client.get("/v1/kinds").json()["items"][1]["inputs"]}
    assert (inputs["image"]["spared_by_input"], inputs["earlier"]["artifact"]) == ("earlier", "preview.jpg")


def test_a_job_that_cannot_be_used_is_refused_at_once(service: Running, picture: bytes) -> None:
    image = uploaded(service, picture)
    assert refused(submit(service, {"earlier": new_id()})) == (422, "unknown_file", PICTURE_INPUT)
    other = submit(service, {"image": image}, kind="tiny").json()["id"]
    assert refused(submit(service, {"earlier": other})) == (422, "job_of_other_kind", PICTURE_INPUT)
    failed = submit(service, {"image": image}, crash="refuse").json()
    assert failed["status"] == "failed"
    assert refused(submit(service, {"earlier": failed["id"]})) == (422, "job_not_succeeded", PICTURE_INPUT)


def test_a_job_of_somebody_else_is_none(service: Running, done: dict[str, Any]) -> None:
    made = service.client.post("/v1/keys", json={"name": "another", "scopes": ["submit"]}).raise_for_status().json()
    asked = {"kind": "following", "inputs": {"earlier": done["id"]}}
    answer = service.client.post("/v1/jobs", json=asked, headers={"Authorization": f"Bearer {made['token']}"})
    assert refused(answer) == (422, "unknown_file", PICTURE_INPUT)


def test_what_was_erased_cannot_be_used_again(service: Running, done: dict[str, Any]) -> None:
    next_one = submit(service, {"earlier": done["id"]}).json()
    service.client.delete(f"/v1/jobs/{done['id']}").raise_for_status()
    assert refused(submit(service, {"earlier": done["id"]})) == (422, "unknown_file", PICTURE_INPUT)
    answer = service.client.post(f"/v1/jobs/{next_one['id']}/revisions", json={"options": {"level": 1.0}})
    assert refused(answer) == (422, "input_erased", PICTURE_INPUT)
    given = uploaded(service, service.client.get(next_one["artifacts"]["preview.jpg"]["url"]).content)
    assert submit(service, {"earlier": given}).json()["status"] == "succeeded"


def test_a_job_whose_beginning_is_erased_while_it_waits_says_so(service: Running, done: dict[str, Any]) -> None:
    image = done["inputs"]["image"]
    asked = {"kind": "following", "inputs": {"image": image}, "options": {"seconds": 60, "rest_once": True}}
    before = service.client.post("/v1/jobs", json=asked).json()["id"]  # one job works at once: the next one waits
    service.until(before, "running")
    waiting = service.client.post("/v1/jobs", json={"kind": "following", "inputs": {"earlier": done["id"]}}).json()
    service.client.delete(f"/v1/jobs/{done['id']}").raise_for_status()
    service.client.post(f"/v1/jobs/{before}/cancel").raise_for_status()
    assert service.until(waiting["id"], "failed")["error"]["code"] == "input_erased"


def test_what_shows_the_same_person_is_erased_together(service: Running, picture: bytes) -> None:
    image = uploaded(service, picture)
    first, other = (submit(service, {"image": image}, "together").json() for _ in range(2))
    second = submit(service, {"earlier": first["id"]}, "together").json()
    third = submit(service, {"earlier": second["id"]}, "together", level=1.0).json()
    beside = submit(service, {"earlier": other["id"]}, "together").json()
    addresses = [job["artifacts"]["preview.jpg"]["url"] for job in (first, second, third)]
    service.client.delete(f"/v1/jobs/{first['id']}").raise_for_status()
    assert [service.client.get(f"/v1/jobs/{job['id']}").status_code for job in (first, second, third)] == [404] * 3
    assert [service.client.get(address).status_code for address in addresses] == [404] * 3
    assert not any((service.data_dir / "jobs" / job["id"]).exists() for job in (first, second, third))
    for job in (other, beside):
        service.client.get(job["artifacts"]["preview.jpg"]["url"]).raise_for_status()
