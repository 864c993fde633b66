"""Adds up JUnit reports: a line for each, and `N passed, N failed, N skipped` as the last one."""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree as ET


def outcomes(report: Path) -> Counter[str]:
    """How many test cases of a JUnit file passed, failed (errors included) and were skipped."""
    counts: Counter[str] = Counter()
    for case in ET.parse(report).iter("testcase"):  # noqa: S314 (written by our own test runners)
        children = {child.tag for child in case}
        if children & {"failure", "error"}:
            counts["failed"] += 1
        else:
            counts["skipped" if "skipped" in children else "passed"] += 1
    return counts


def line(counts: Counter[str]) -> str:
    return f"{counts['passed']} passed, {counts['failed']} failed, {counts['skipped']} skipped"


def main(reports: list[Path]) -> None:
    total: Counter[str] = Counter()
    for report in reports:
        counts = outcomes(report)
        total += counts
        print(f"{report.stem:<12} {line(counts)}")
    print(line(total))


if __name__ == "__main__":
    main([Path(name) for name in sys.argv[1:] if Path(name).exists()])
