"""`report.json`: what a run did, measured and warned of."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import engine
from engine.run import Run


def write_report(
    path: Path,
    kind: str,
    run: Run,
    inputs: Mapping[str, Any],
    quality: Mapping[str, float],
    more: Mapping[str, Any] | None = None,
) -> None:
    """Write `report.json` as every run leaves it; `more` is what this kind alone has to say."""
    report = {
        "kind": kind,
        "engine_version": engine.__version__,
        "stages": {name: round(seconds, 4) for name, seconds in run.seconds.items()},
        "inputs": dict(inputs),
        "quality": dict(quality),
        **(more or {}),
        "warnings": [asdict(notice) for notice in run.notices],
    }
    path.write_text(json.dumps(report, indent=2) + "\n")
