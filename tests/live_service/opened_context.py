"""An opened context over an empty data folder; no Redis runs."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from newest_tables import lay_out_data_folder

from service.context import Context
from service.settings import Settings


@pytest.fixture
def context(tmp_path: Path) -> Iterator[Context]:
    lay_out_data_folder(tmp_path / "data")
    yield from _opened(Settings(data_dir=tmp_path / "data", kinds=[], disk_reserve_mb=0))


@pytest.fixture
def context_on_any(tmp_path: Path, database_url: str) -> Iterator[Context]:
    """An opened context over an empty database of each kind."""
    yield from _opened(Settings(data_dir=tmp_path / "data", database_url=database_url, kinds=[], disk_reserve_mb=0))


def _opened(settings: Settings) -> Iterator[Context]:
    opened = Context.open(settings)
    yield opened
    opened.close()
