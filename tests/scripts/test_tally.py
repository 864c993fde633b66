"""The closing line of `make test` adds up what its parts report."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

TALLY = Path(__file__).parents[2] / "scripts" / "tally.py"

PYTEST = """<testsuites><testsuite name="pytest">
<testcase name="a"/><testcase name="b"><failure message="no"/></testcase>
<testcase name="c"><skipped message="no media"/></testcase><testcase name="d"><error message="set-up"/></testcase>
</testsuite></testsuites>"""
VITEST = """<testsuites><testsuite name="unit"><testcase name="e"/><testcase name="f"/></testsuite></testsuites>"""


def closing_lines(*reports: Path) -> list[str]:
    command = [sys.executable, str(TALLY), *map(str, reports)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()


def test_adds_up_reports(tmp_path: Path) -> None:
    (tmp_path / "python.xml").write_text(PYTEST)
    (tmp_path / "web-unit.xml").write_text(VITEST)
    lines = closing_lines(tmp_path / "python.xml", tmp_path / "web-unit.xml", tmp_path / "never-written.xml")
    assert lines == [
        "FAILED b",
        "  no",
        "",
        "FAILED d",
        "  set-up",
        "",
        "python       1 passed, 2 failed, 1 skipped",
        "web-unit     2 passed, 0 failed, 0 skipped",
        "3 passed, 2 failed, 1 skipped",
    ]
