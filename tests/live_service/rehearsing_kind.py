"""The tiny kind, under two names, with a rehearsal that lasts until the file is there that `REHEARSED_WHEN` names."""

from __future__ import annotations

import os
import time
from dataclasses import replace
from pathlib import Path

from tiny_kind import KIND as TINY


def rehearse(folder: Path) -> None:
    while not Path(os.environ["REHEARSED_WHEN"]).exists():
        time.sleep(0.05)


KIND = replace(TINY, rehearse=rehearse)
OTHER = replace(KIND, name="other")
