"""docker-compose.yml: what it promises about each service, and that it speaks of settings that there are.

No Docker engine runs here: that the containers work together is not tested.
"""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import Any

import pytest
import yaml

from service.settings import Settings
from worker.programs.interpreter import module_command

ROOT = Path(__file__).parent.parent
TEXT = (ROOT / "docker-compose.yml").read_text()
COMPOSE = yaml.safe_load(TEXT)
SERVICES: dict[str, dict[str, Any]] = COMPOSE["services"]
ENDING = {"first-key", "s3-folder"}
"""Services that do one thing and end."""


@pytest.mark.parametrize("name", SERVICES)
def test_it_is_pinned_limited_and_confined(name: str) -> None:
    service = SERVICES[name]
    assert re.fullmatch(r"[\w./-]+:v?\d+\.\d+[\w.-]*", service["image"]), "a version, and not only a part of one"
    assert {"cpus", "memory"} <= set(service["deploy"]["resources"]["limits"])
    assert service["cap_drop"] == ["ALL"] and service["read_only"] is True
    assert service["security_opt"] == ["no-new-privileges:true"]
    if name != "s3-folder":
        assert int(service["user"].split(":")[0]) > 0, "it does not run as root"


@pytest.mark.parametrize("name", sorted(set(SERVICES) - ENDING))
def test_it_says_whether_it_is_well_and_starts_again(name: str) -> None:
    assert SERVICES[name]["healthcheck"]["test"][0] in ("CMD", "CMD-SHELL")
    assert SERVICES[name]["restart"] == "unless-stopped"


@pytest.mark.parametrize("name", SERVICES)
def test_it_waits_for_what_it_needs(name: str) -> None:
    for other, how in SERVICES[name].get("depends_on", {}).items():
        assert how["condition"] == ("service_completed_successfully" if other in ENDING else "service_healthy")
        assert other in SERVICES


def test_the_health_of_a_worker_is_not_that_of_its_check() -> None:
    """The check finds the process that does the work, and would not find itself."""
    _, script = SERVICES["worker"]["healthcheck"]["test"]
    pattern = shlex.split(script)[2]
    assert re.search(pattern, " ".join(module_command("worker.job_process.child")))
    assert not re.search(pattern, script)


def test_its_settings_are_there_and_make_sense() -> None:
    for service in ("first-key", "api", "worker"):
        given = SERVICES[service]["environment"]
        names = {name.removeprefix("GALATEA_").lower() for name in given}
        assert names <= set(Settings.model_fields)
        given = {name: re.sub(r"\$\{\w+:-\}", "", value) for name, value in given.items()}
        filled = {name: re.sub(r"\$\{[^}]*\}", "secret", value) for name, value in given.items()}
        Settings(**{name.removeprefix("GALATEA_").lower(): value for name, value in filled.items()})


def test_secrets_come_from_the_environment_file_alone() -> None:
    example = (ROOT / "docs" / "operations" / "compose.env").read_text()
    asked = set(re.findall(r"(?<!\$)\$\{(\w+)", TEXT))
    assert asked == set(re.findall(r"(?m)^(\w+)=", example))
    assert re.findall(r"(?m)^\w+=.+", example) == [], "the example holds no values"


def test_only_this_machine_reaches_it_and_the_stores_are_reached_by_it_alone() -> None:
    published = {name: service["ports"] for name, service in SERVICES.items() if "ports" in service}
    assert published == {"api": ["127.0.0.1:8000:8000"]}
    assert COMPOSE["networks"]["stores"] == {"internal": True}
    assert all(SERVICES[name]["networks"] == ["stores"] for name in ("postgres", "redis", "s3"))


def test_the_image_runs_as_nobody_special() -> None:
    lines = (ROOT / "Dockerfile").read_text().splitlines()
    assert [line for line in lines if line.startswith("USER ")] == ["USER galatea"]
    for line in lines:
        if line.startswith("FROM "):
            assert re.search(r":\d+\.\d+(\.\d+)?-[\w-]+( AS \w+)?$", line), "a version, and not only a part of one"
