"""The figures of personas, printed as the tables of `docs/figures.md`.

python benchmarks/persona.py speed|held_out|shape|correspondence|flicker|all [--collections NAME ...]
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from benchmarks.persona_figures import correspondence, flicker, held_out, shape, speed
from benchmarks.presentation.tables import machine

PERSONA_TABLES = ("speed", "held_out", "shape", "correspondence", "flicker")


def main() -> None:
    """Read the command line and print the tables asked for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("what", nargs="?", default="all", choices=(*PERSONA_TABLES, "all"))
    parser.add_argument("--collections", nargs="+", default=[], metavar="NAME", help="by part of their name")
    parser.add_argument("--repeats", type=int, default=3, help="speed: how often each case is timed (default 3)")
    parser.add_argument("--photos", type=int, metavar="N", help="speed: only the first N photos")
    parser.add_argument(
        "--folds", type=int, default=10, help="held_out: into how many parts a collection is cut (default 10)"
    )
    given = parser.parse_args()
    print(f"Taken on {machine()}")
    if given.what in ("speed", "all"):
        speed.speed(given.collections, given.photos, given.repeats)
    if given.what in ("held_out", "all"):
        held_out.held_out(given.collections, given.folds)
    if given.what in ("shape", "all"):
        shape.shape()
    if given.what in ("correspondence", "all"):
        correspondence.correspondence()
    if given.what in ("flicker", "all"):
        flicker.flicker(given.collections)


if __name__ == "__main__":
    main()
