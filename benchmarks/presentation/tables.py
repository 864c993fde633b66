"""Tables for people and for the documentation: aligned columns, in Markdown."""

from __future__ import annotations

import os
import platform
from collections.abc import Sequence
from pathlib import Path


def table(title: str, head: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """A Markdown table under its title; numbers are given as strings of the wanted precision."""
    cells = [list(head), *([str(cell) for cell in row] for row in rows)]
    widths = [max(len(row[k]) for row in cells) for k in range(len(head))]

    def line(row: Sequence[str]) -> str:
        first = row[0].ljust(widths[0])
        return "| " + " | ".join([first, *(cell.rjust(w) for cell, w in zip(row[1:], widths[1:], strict=True))]) + " |"

    rule = "|" + "|".join("-" * (w + 1) + (":" if k else "-") for k, w in enumerate(widths)) + "|"
    return "\n".join([f"\n### {title}\n", line(cells[0]), rule, *(line(row) for row in cells[1:])])


def mean_row(label: str, rows: Sequence[Sequence[float | None]], digits: Sequence[int]) -> list[str]:
    """The columns' means over the rows that have them."""
    columns = [[v for v in column if v is not None] for column in zip(*rows, strict=True)]
    return [label, *(f"{sum(c) / len(c):.{d}f}" if c else "" for c, d in zip(columns, digits, strict=True))]


def machine() -> str:
    """What the figures were taken on."""
    model = platform.processor() or platform.machine()
    if Path("/proc/cpuinfo").exists():
        names = [
            x.split(":", 1)[1] for x in Path("/proc/cpuinfo").read_text().splitlines() if x.startswith("model name")
        ]
        model = names[0].strip() if names else model
    load = os.getloadavg()[0]
    cores = len(os.sched_getaffinity(0))
    busy = f"; WARNING: the machine was busy (load {load:.1f})" if load > 1.5 * cores else ""
    return f"{model}, {cores} cores, Python {platform.python_version()}, {platform.system()}{busy}"
