"""An opened context over an empty data folder; no Redis runs."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from service.context import Context
from service.settings import Settings


@pytest.fixture
def context(tmp_path: Path) -> Iterator[Context]:
    opened = Context.open(Settings(data_dir=tmp_path / "data", kinds=[], disk_reserve_mb=0))
    yield opened
    opened.close()
