"""What a job may take: what its kind needs, as far as the operator allows it."""

from __future__ import annotations

from pathlib import Path

import pytest
from pydantic import BaseModel

from engine.kind import Kind, Needs
from service.catalogue.allowance import Allowance
from service.settings import Settings


def allowed(tmp_path: Path, **needs: float) -> Allowance:
    kind = Kind("painting", "", (), BaseModel, lambda *_: None, needs=Needs(**needs))  # type: ignore[arg-type]
    return Allowance.of(kind, Settings(data_dir=tmp_path, job_seconds=100, job_memory_mb=1000, job_cores=4))


@pytest.mark.parametrize(
    ("needs", "expected"),
    [
        ({}, (100, 1000, 4, None)),
        ({"seconds": 30, "memory_mb": 200, "cores": 1}, (30, 200, 1, "painting")),
        ({"seconds": 900, "memory_mb": 9000, "cores": 16}, (100, 1000, 4, None)),
    ],
)
def test_the_smaller_of_need_and_setting_holds(
    tmp_path: Path, needs: dict[str, float], expected: tuple[float, float, int, str | None]
) -> None:
    found = allowed(tmp_path, **needs)
    assert (found.seconds, found.memory_mb, found.cores, found.kind) == expected


def test_where_neither_bounds_the_cores_all_may_be_used(tmp_path: Path) -> None:
    kind = Kind("painting", "", (), BaseModel, lambda *_: None)
    assert Allowance.of(kind, Settings(data_dir=tmp_path, job_cores=0)).cores == 0


def test_who_took_too_long_is_told_whose_limit_it_was(tmp_path: Path) -> None:
    assert "30 seconds" in (own := allowed(tmp_path, seconds=30).too_long()) and "“painting”" in own
    assert "GALATEA_JOB_SECONDS" in allowed(tmp_path).too_long()
