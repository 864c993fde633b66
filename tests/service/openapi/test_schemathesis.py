"""The whole API against its own OpenAPI document: schemathesis, all checks on, a service that runs."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

from running import HERE, Running
from servers import PostgresServer

SEED = 4711
EXAMPLES, SECONDS = 40, 10
"""Random requests for each operation, at most; how long each random phase goes on."""

SETTINGS = {"image_mb": 1, "video_mb": 2, "wait_seconds": 0.3, "allowed_networks": "127.0.0.0/8"}

CONFIGURATION = """
# No text may hold a NUL, whatever a document says of it: tests/hostile sends them to every endpoint.
[generation]
allow-x00 = false

# Beside a file, the coverage phase takes an empty text for a name that suits the pattern.
[[operations]]
include-operation-id = "create_driver"
checks.positive_data_acceptance.expected-statuses = ["2xx", "409", "422"]

[[operations]]
include-operation-id = "create_motion"
checks.positive_data_acceptance.expected-statuses = ["2xx", "409", "422"]

# What the document cannot say: that a piece sums up to its checksum, that a length is told now or later but not both,
# how much the service under test takes.
[[operations]]
include-operation-id = "create_upload"
checks.positive_data_acceptance.expected-statuses = ["2xx", "400", "413", "422", "460"]

[[operations]]
include-operation-id = "add_to_upload"
checks.positive_data_acceptance.expected-statuses = ["2xx", "400", "404", "409", "413", "460"]

# A driver has no picture before it was searched, and no search where that kind of job is not on offer.
[[operations]]
include-operation-id = "get_driver_poster"
phases.stateful.enabled = false

[[operations]]
include-operation-id = "search_driver"
checks.positive_data_acceptance.expected-statuses = ["2xx", "404", "409", "422"]

[[operations]]
include-operation-id = "check_motion"
checks.positive_data_acceptance.expected-statuses = ["2xx", "404", "409", "422"]

# A key that was revoked is still shown, with the moment at which it was.
[[operations]]
include-operation-id = "get_key"
phases.stateful.enabled = false

# A version of the tus protocol that is not spoken is answered by 412: so the protocol says.
[checks.negative_data_rejection]
expected-statuses = ["400", "401", "403", "404", "405", "406", "409", "412", "415", "422", "428", "429"]
"""


def test_every_bound_of_every_parameter_where_a_key_is_needed(
    start: Callable[..., Running], picture: bytes, tmp_path: Path
) -> None:
    running = start(**SETTINGS)
    scopes = ["read", "submit", "admin"]
    asked = {"name": "schemathesis", "scopes": scopes, "requests_per_minute": 1_000_000}
    key = running.client.post("/v1/keys", json=asked).raise_for_status().json()
    running.stop()
    running.settings["require_keys"] = True
    running.settings["wrong_keys_per_minute"] = 1_000_000  # wrong ones are to be told so, however many come
    running.start()
    running.client.headers["Authorization"] = f"Bearer {key['token']}"
    authorization = ("--header", f"Authorization: Bearer {key['token']}")
    faultless(running, picture, tmp_path, "examples,coverage", *authorization, key=key["id"])


def test_what_nobody_would_send_on_another_database(
    start: Callable[..., Running], postgres: PostgresServer, picture: bytes, tmp_path: Path
) -> None:
    running = start(database_url=postgres.new_database(), **SETTINGS)
    faultless(running, picture, tmp_path, "fuzzing")


def test_sequences_of_requests(start: Callable[..., Running], picture: bytes, tmp_path: Path) -> None:
    faultless(start(**SETTINGS), picture, tmp_path, "stateful")


def faultless(running: Running, picture: bytes, folder: Path, phases: str, *arguments: str, key: str = "") -> None:
    file = running.client.post("/v1/files", files={"file": ("picture.png", picture)}).raise_for_status().json()
    job = {"kind": "tiny", "inputs": {"image": file["id"]}}
    keeping = running.client.post("/v1/jobs", json=job).raise_for_status().json()
    (folder / "schemathesis.toml").write_text(CONFIGURATION)
    command = [
        *(sys.executable, "-m", "schemathesis.cli", "--no-color", "--config-file", "schemathesis.toml"),
        *("run", f"{running.client.base_url}/v1/openapi.json", "--checks", "all", "--continue-on-failure"),
        *("--phases", phases, "--seed", str(SEED), "--no-shrink"),
        *("--max-examples", str(EXAMPLES), "--max-time", str(SECONDS), "--generation-database", "none", *arguments),
    ]
    environment = {
        **os.environ,
        "SCHEMATHESIS_HOOKS": "schemathesis_hooks",
        "PYTHONPATH": os.pathsep.join([str(Path(__file__).parent), str(HERE)]),
        "GALATEA_TEST_FILE_ID": file["id"],
        "GALATEA_TEST_KEPT": f"{keeping['id']} {key}",
    }
    done = subprocess.run(command, env=environment, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-20_000:] + done.stderr[-2000:] + running.output.read_text()[-4000:]
