"""Adds up JUnit reports: what failed and why, a line for each report, and `N passed, N failed, N skipped` as the last."""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree as ET

MAX_LINES, MAX_LINE_CHARACTERS = 12, 200  # of each failure's message


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


def reasons(report: Path) -> list[str]:
    """Each failed test case with the first lines of its message."""
    told = []
    for case in ET.parse(report).iter("testcase"):  # noqa: S314 (as above)
        for failure in [*case.iter("failure"), *case.iter("error")]:
            lines = (failure.get("message") or failure.text or "").strip().splitlines()
            name = f"{case.get('classname', '')} {case.get('name', '')}".strip()
            told.append(
                "\n".join([f"FAILED {name}", *(f"  {line[:MAX_LINE_CHARACTERS]}" for line in lines[:MAX_LINES])])
            )
    return told


def line(counts: Counter[str]) -> str:
    return f"{counts['passed']} passed, {counts['failed']} failed, {counts['skipped']} skipped"


def main(reports: list[Path]) -> None:
    total: Counter[str] = Counter()
    for report in reports:
        for reason in reasons(report):
            print(f"{reason}\n")
    for report in reports:
        counts = outcomes(report)
        total += counts
        print(f"{report.stem:<12} {line(counts)}")
    print(line(total))


if __name__ == "__main__":
    main([Path(name) for name in sys.argv[1:] if Path(name).exists()])
