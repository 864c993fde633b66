"""What tests share is handed on as it was."""

from __future__ import annotations

from running import Running


def test_what_a_test_leaves_is_ended_with_it(shared_service: Running, picture: bytes) -> None:
    shared_service.rest(picture, polls=False)
    left = [shared_service.submit(picture)["id"] for _ in range(3)]
    shared_service.end_jobs()
    assert {shared_service.job(job)["status"] for job in left} == {"canceled"}
    assert not list((shared_service.data_dir / "jobs").glob("*/attempt-*"))
    assert shared_service.client.get("/v1/jobs", params={"status": ["queued", "running"]}).json()["items"] == []
