"""The figures of the portrait system, printed as the tables of `docs/figures.md`.

python benchmarks/portrait.py speed|fidelity|ablations|stillness|lag|turn|solidity|pair|mouths|memory|all
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from benchmarks.portrait_figures import fidelity, memory, mouths_and_eyes, solidity, speed, steadiness, turn
from benchmarks.presentation.tables import machine

PORTRAIT_TABLES = ("speed", "fidelity", "ablations", "stillness", "lag", "turn", "solidity", "pair", "mouths", "memory")


def main() -> None:
    """Read the command line and print the tables asked for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("what", nargs="?", default="all", choices=(*PORTRAIT_TABLES, "all"))
    parser.add_argument("--clips", nargs="+", default=[], metavar="NAME", help="driving clips by part of their name")
    parser.add_argument("--repeats", type=int, default=3, help="speed: how often each case is timed (default 3)")
    parser.add_argument("--frames", type=int, default=100, help="speed: frames of the clip (default 100)")
    parser.add_argument("--pictures", type=Path, metavar="DIR", help="keep contact sheets here")
    given = parser.parse_args()
    print(f"Taken on {machine()}")
    for name in PORTRAIT_TABLES if given.what == "all" else (given.what,):
        if name == "speed":
            speed.speed(given.repeats, given.frames)
        elif name == "fidelity":
            fidelity.fidelity(given.clips, given.pictures)
        elif name == "ablations":
            fidelity.ablations(given.clips, given.pictures)
        elif name == "stillness":
            steadiness.stillness(given.clips)
        elif name == "lag":
            steadiness.lag(given.clips)
        elif name == "turn":
            turn.turn(given.pictures)
        elif name == "solidity":
            solidity.solidity()
        elif name == "pair":
            fidelity.pair(given.pictures)
        elif name == "mouths":
            mouths_and_eyes.mouths_and_eyes(given.clips)
        else:
            memory.memory()
        sys.stdout.flush()


if __name__ == "__main__":
    main()
