"""The same service on PostgreSQL and S3: what could be different there, and what happens when they go away."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from running import Running, eventually
from servers import Gate, PostgresServer, S3Server

from service.settings import Settings
from service.storage.bucket import Bucket
from tests.service.artifacts.test_artifacts import (  # noqa: F401
    artifact,
    test_all_of_them_come_as_one_zip,
    test_names_that_are_no_artifacts,
    test_one_range,
    test_ranges_outside,
    test_several_ranges,
    test_whole,
)
from tests.service.drivers.test_drivers import test_a_job_can_name_a_built_in_performance  # noqa: F401
from tests.service.events.test_events import (  # noqa: F401
    test_a_connection_that_broke_misses_nothing,
    test_a_stream_resumes_after_the_last_event_and_then_says_that_there_is_no_more,
)
from tests.service.jobs.test_jobs import (  # noqa: F401
    test_a_form_carries_the_files_themselves,
    test_deleting_a_running_job_stops_it,
    test_one_key_makes_one_job,
    test_the_list_is_newest_first_filtered_and_paged,
)
from tests.service.jobs.test_revisions import (  # noqa: F401
    done,
    revise,
    test_a_revision_reuses_stored_stages_and_says_whose_it_is,
    test_one_key_makes_one_revision,
)
from tests.service.links.test_links import (  # noqa: F401
    test_a_link_ends_with_its_time_and_with_its_job,
    test_a_link_opens_what_it_names_to_pages_of_any_origin,
)
from tests.service.uploads.test_uploads import (  # noqa: F401
    test_an_upload_can_be_ended,
    test_checksums_are_met_or_the_piece_is_not_kept,
    test_pieces_become_a_file_under_the_same_id_that_a_job_takes,
)
from tests.worker.job_files.test_url_inputs import Host
from tests.worker.test_killed import attempts, test_a_worker_killed_in_mid_job_finishes_it_later_once  # noqa: F401


@pytest.fixture(scope="module")
def shared_service(
    tmp_path_factory: pytest.TempPathFactory, postgres: PostgresServer, s3: S3Server
) -> Iterator[Running]:
    """The service that the tests of this module share, the borrowed ones too."""
    data = tmp_path_factory.mktemp("shared") / "data"
    patience = {"lease_seconds": 3, "sweep_seconds": 0.5, "allowed_networks": "127.0.0.0/8"}
    service = Running(data, database_url=postgres.new_database(), **s3.new_bucket(), **patience)
    yield service
    service.stop()


@pytest.fixture
def start(tmp_path: Path, postgres: PostgresServer, s3: S3Server) -> Iterator[Callable[..., Running]]:
    """`start(setting=value)` is a service for one test that may do to it what it likes."""
    started: list[Running] = []

    def begin(**settings: Any) -> Running:
        shared = {"database_url": postgres.new_database(), **s3.new_bucket()}
        given = {"lease_seconds": 3, "sweep_seconds": 0.5, **shared, **settings}
        started.append(Running(tmp_path / f"data{len(started)}", **given))
        return started[-1]

    yield begin
    for service in started:
        service.stop()


def stored(running: Running) -> set[str]:
    """The keys of all that lies in the service's bucket."""
    names = ("storage_url", "storage_endpoint", "storage_access_key", "storage_secret_key")
    bucket = Bucket(Settings(**{name: running.settings[name] for name in names}, storage_region="us-east-1"))
    return set(bucket.keys(""))


def test_an_input_by_address_lies_in_the_bucket_until_its_job_is_erased(running: Running, picture: bytes) -> None:
    before, host = stored(running), Host(picture)
    asked = {"kind": "tiny", "inputs": {"image": host.url("/a.png")}}
    job = running.client.post("/v1/jobs", json=asked).raise_for_status().json()
    running.until(job["id"], "succeeded")
    assert len([key for key in stored(running) - before if key.startswith("files/")]) == 1
    running.client.delete(f"/v1/jobs/{job['id']}").raise_for_status()
    eventually(lambda: stored(running) <= before, "nothing is left")
    host.shutdown()
    host.server_close()


def test_nothing_of_a_job_lies_on_the_machine_and_nothing_stays_in_the_bucket(running: Running, picture: bytes) -> None:
    before = stored(running)
    job = running.until(running.submit(picture)["id"], "succeeded")
    assert not (running.data_dir / "storage").exists()
    assert not (running.data_dir / "galatea.db").exists()
    kept = stored(running) - before
    assert f"files/{job['inputs']['image']}" in kept
    assert len([key for key in kept if key.startswith("artifacts/")]) == len(job["artifacts"])
    assert running.client.delete(f"/v1/jobs/{job['id']}").status_code == 204
    eventually(lambda: stored(running) <= before, "the bucket is as it was")


def test_a_running_job_and_its_followers_survive_a_restart_of_the_database(
    start: Callable[..., Running], postgres: PostgresServer, picture: bytes
) -> None:
    running = start(lease_seconds=90)
    job = running.submit(picture, seconds=6)
    running.until_at_rest(job["id"])
    postgres.stop()
    refused = running.client.get(f"/v1/jobs/{job['id']}")
    assert (refused.status_code, refused.json()["code"]) == (503, "unavailable")
    assert int(refused.headers["retry-after"]) > 0
    assert running.client.get("/readyz").json()["checks"]["database"] is False
    postgres.start()
    ended = running.until(job["id"], "succeeded", "failed")
    assert ended["status"] == "succeeded", ended["error"]
    assert attempts(running, job["id"]) == 1, "it went on as if nothing had been"
    assert running.client.get(ended["artifacts"]["animation.mp4"]["url"]).status_code == 200


def test_a_storage_that_is_away_is_said_and_costs_no_job(
    start: Callable[..., Running], s3: S3Server, picture: bytes
) -> None:
    way = Gate(s3.host, s3.port)
    running = start(**s3.new_bucket() | {"storage_endpoint": f"http://127.0.0.1:{way.port}"})
    ended = running.until(running.submit(picture)["id"], "succeeded")
    way.shut()
    assert running.client.get("/readyz").json()["checks"]["storage"] is False
    waiting = running.client.post("/v1/jobs", json={"kind": "tiny", "inputs": ended["inputs"]}).json()
    running.until(waiting["id"], "running")
    refused = running.client.get(ended["artifacts"]["report.json"]["url"])
    assert (refused.status_code, refused.json()["code"]) == (503, "unavailable")
    assert running.client.delete(f"/v1/jobs/{ended['id']}").status_code == 204, "housekeeping will see to its media"
    way.open()
    running.until(waiting["id"], "succeeded")
