"""Reads streams of EXT_meshopt_compression by a decoder that shares nothing with what wrote them: that of three.js."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

from glb_reader import ROOT
from missing import missing


def decoded(path: Path, plain: Path) -> Path:
    """A compressed GLB as one that is not, written to `plain`. Skips where three.js is not installed, fails where it must be."""
    if shutil.which("node") is None or not (ROOT / "web/node_modules/three").exists():
        missing("three is not installed (make setup installs it)")
    script = Path(__file__).with_name("decode_meshopt.mjs")
    subprocess.run(["node", script, path, plain], check=True, timeout=60)
    return plain
