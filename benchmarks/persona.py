"""The figures of personas, printed as the tables of `docs/figures.md`.

python benchmarks/persona.py speed|all [--collections NAME ...]
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from benchmarks.persona_figures import speed
from benchmarks.tables import machine

TABLES = ("speed",)


def main() -> None:
    """Read the command line and print the tables asked for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("what", nargs="?", default="all", choices=(*TABLES, "all"))
    parser.add_argument("--collections", nargs="+", default=[], metavar="NAME", help="by part of their name")
    parser.add_argument("--repeats", type=int, default=3, help="speed: how often each case is timed (default 3)")
    parser.add_argument("--photos", type=int, metavar="N", help="speed: only the first N photos")
    given = parser.parse_args()
    print(f"Taken on {machine()}")
    speed.speed(given.collections, given.photos, given.repeats)


if __name__ == "__main__":
    main()
