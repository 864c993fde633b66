"""The documentation as a site: it builds without a warning, and asks nobody else for anything."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent.parent

LOADS = re.compile(
    r"""<(?:script|img|iframe|source|video|audio|embed|object|form)\b[^>]*?\b(?:src|data|action|srcset)\s*=\s*["']?([^"'\s>]+)"""
    r"""|<link\b[^>]*?\bhref\s*=\s*["']?([^"'\s>]+)|url\(\s*["']?([^"')]+)|@import\s+["']([^"']+)""",
    re.IGNORECASE,
)
"""What a browser fetches by itself; a link that a reader may follow is no such thing."""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(folder)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


def test_no_page_loads_anything_from_elsewhere(site: Path) -> None:
    pages = [*site.rglob("*.html"), *site.rglob("*.css")]
    assert len(pages) > 15
    for page in pages:
        for found in LOADS.findall(page.read_text()):
            address = next(filter(None, found))
            assert not re.match(r"(https?:)?//", address), (page.name, address)


def test_every_operation_has_its_place_in_the_reference(site: Path) -> None:
    from scripts.openapi import document

    text = "".join(page.read_text() for page in (site / "reference").glob("*.html"))
    told = document()
    for item in told["paths"].values():
        for operation in item.values():
            assert f'id="{operation["operationId"]}"' in text
    for name in told["components"]["schemas"]:
        assert f'id="{name.lower()}"' in text


def test_every_page_is_in_the_table_of_contents(site: Path) -> None:
    start = (site / "index.html").read_text()
    for page in (ROOT / "docs").rglob("*.md"):
        assert str(page.relative_to(ROOT / "docs").with_suffix(".html")) in start or page.name == "index.md", page


def test_pictures_are_small() -> None:
    sizes = {path.name: path.stat().st_size for path in (ROOT / "docs" / "pictures").iterdir()}
    assert {name: size for name, size in sizes.items() if name != "portrait.jpg" and size > 150_000} == {}
