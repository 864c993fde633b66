"""Film a subject of known shape, with the truth beside the films.

python -m benchmarks.scan_studio SUBJECT OUT [--size 360x640] [--format hevc] [--sway 0.005] [--still]
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

from benchmarks.scan_studio.conditions import NAMED_CONDITIONS
from benchmarks.scan_studio.film import NAMED_CODINGS
from benchmarks.scan_studio.people.subjects import SUBJECTS, subject_named
from benchmarks.scan_studio.people.sway import USUAL_METRES
from benchmarks.scan_studio.studio import Order, film


def _size(text: str) -> tuple[int, int]:
    width, height = map(int, text.split("x"))
    if width % 2 or height % 2:
        raise argparse.ArgumentTypeError("width and height must be even")
    return width, height


def main() -> None:
    """Read the order, and film."""
    parser = argparse.ArgumentParser("scan_studio", description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("subject", choices=SUBJECTS)
    parser.add_argument("out", type=Path)
    parser.add_argument("--size", type=_size, default=(360, 640), help="width x height of the upright films")
    parser.add_argument("--body-frames", type=int, default=192)
    parser.add_argument("--head-frames", type=int, default=96, help="0: no film of the head")
    parser.add_argument(
        "--format", choices=tuple(NAMED_CODINGS), default="h264", help="hlg: HEVC, 10 bits, of high dynamic range"
    )
    parser.add_argument("--sway", type=float, default=USUAL_METRES, help="metres that the chest moves, at most")
    parser.add_argument("--still", action="store_true", help="the subject does not move at all")
    parser.add_argument(
        "--conditions", choices=tuple(NAMED_CONDITIONS), default="good", help="or one of the usual faults"
    )
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    began = time.perf_counter()
    frames = {"body": given.body_frames, "head": given.head_frames}
    order = Order(frames, given.size, given.format, 0.0 if given.still else given.sway, given.seed, given.conditions)
    film(subject_named(given.subject), order, given.out)
    print(f"{given.out}: {time.perf_counter() - began:.1f} s")


if __name__ == "__main__":
    main()
