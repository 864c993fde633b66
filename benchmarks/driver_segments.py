"""How well the segments of a driver are found: `python -m benchmarks.driver_segments`.

Two kinds of truth. By construction: the built-in performances, joined in random orders into long clips, hold what
their names say, and those of waiting hold no emotion. By eye: `driver_segments.json` says what the real clips of the test
media hold (`must`), and what one may see in them or not (`may`: neither right nor wrong).

A segment is right where its height lies in a stretch of the same state, or where both share 0.3 of what they cover
together. A stretch is found where a segment is right of it.

The thresholds were set with these performances and these clips in view: the figures say how well they are told apart,
not how it will go with every stranger. So the real clips are judged altered too: mirrored and small, tilted and dark.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.presentation.tables import machine, table
from benchmarks.shared_media import media, write_clip
from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.media.video import read_video
from engine.performances import PERFORMANCE_STATES, names, performance, video
from engine.portrait.driver_segments import find_segments
from engine.portrait.driver_segments.pipeline import DriverSegment

ORDER_SEEDS = (1, 2, 3, 4)
MIN_OVERLAP_SHARE = 0.3
"""Share of two stretches of time together that they have in common, from which they are one."""
JOINED_TITLE = "Built-in performances, joined"
LABELS_FILE = Path(__file__).with_suffix(".json")


@dataclass(frozen=True)
class Stretch:
    """From `start` to `end` seconds a clip shows a state."""

    state: str
    start: float
    end: float


def join(performances: Sequence[str], path: Path, mirrored: bool = False) -> list[Stretch]:
    """Write the built-in performances one after another as one clip; what it holds then."""
    truth, time, fps = [], 0.0, 30.0
    with VideoWriter(VideoTarget(path, (512, 512), fps)) as writer:
        for name in performances:
            frames = 0
            for frame in read_video(video(name)):
                writer.write(np.ascontiguousarray(frame.rgb[:, ::-1]) if mirrored else frame.rgb)
                frames += 1
            truth.append(Stretch(performance(name).state, time, time + frames / fps))
            time += frames / fps
    return truth


def in_random_order(seed: int, times: int = 1) -> list[str]:
    """All built-in performances, shuffled."""
    shuffled = list(names()) * times
    np.random.default_rng(seed).shuffle(shuffled)
    return shuffled


def mirrored_and_small(rgb: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Mirrored, the longest side 300 pixels."""
    height, width = (int(side * 300 / max(rgb.shape)) // 2 * 2 for side in rgb.shape[:2])
    return np.asarray(cv2.resize(rgb[:, ::-1], (width, height), interpolation=cv2.INTER_AREA), np.uint8)


def tilted_and_dark(rgb: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Turned by 7 degrees, with half of the brightness."""
    height, width = (side // 2 * 2 for side in rgb.shape[:2])
    turn = cv2.getRotationMatrix2D((width / 2, height / 2), 7.0, 1.0)
    turned = cv2.warpAffine(rgb, turn, (width, height), borderMode=cv2.BORDER_REPLICATE)
    return np.asarray(turned * 0.55, np.uint8)


VIDEO_ALTERATIONS = {"as they are": None, "mirrored and small": mirrored_and_small, "tilted and dark": tilted_and_dark}


def is_right(segment: DriverSegment, stretch: Stretch) -> bool:
    """Whether a segment tells of a stretch."""
    if segment.state != stretch.state:
        return False
    common = min(segment.end, stretch.end) - max(segment.start, stretch.start)
    together = max(segment.end, stretch.end) - min(segment.start, stretch.start)
    return stretch.start <= segment.apex <= stretch.end or common / together >= MIN_OVERLAP_SHARE


@dataclass
class Tally:
    """Segments that are right and wrong, stretches that are found and missed."""

    right: int = 0
    wrong: int = 0
    found: int = 0
    missed: int = 0

    def row(self, name: str) -> list[str]:
        return [name, *map(str, (self.right, self.wrong, self.found, self.missed)), self._precision(), self._recall()]

    def _precision(self) -> str:
        return f"{self.right / (self.right + self.wrong):.2f}" if self.right + self.wrong else ""

    def _recall(self) -> str:
        return f"{self.found / (self.found + self.missed):.2f}" if self.found + self.missed else ""


def judge(
    tallies: Mapping[str, Tally],
    segments: Sequence[DriverSegment],
    must: Sequence[Stretch],
    may: Sequence[Stretch] = (),
) -> list[str]:
    """Count what is right, by state; what is wrong or missed, in words."""
    faults = []
    for segment in segments:
        if any(is_right(segment, stretch) for stretch in must):
            tallies[segment.state].right += 1
        elif not any(is_right(segment, stretch) for stretch in may):
            tallies[segment.state].wrong += 1
            faults.append(f"wrong: {segment.name} {segment.start:.2f} to {segment.end:.2f} s")
    for stretch in must:
        if any(is_right(segment, stretch) for segment in segments):
            tallies[stretch.state].found += 1
        else:
            tallies[stretch.state].missed += 1
            faults.append(f"missed: {stretch.state} {stretch.start:.2f} to {stretch.end:.2f} s")
    return faults


def labels() -> dict[str, tuple[list[Stretch], list[Stretch]]]:
    """What was seen in the real clips, by file name: what must be found, and what may be."""
    document = json.loads(LABELS_FILE.read_text())
    return {
        name: ([Stretch(*one) for one in seen["must"]], [Stretch(*one) for one in seen["may"]])
        for name, seen in document.items()
    }


def main() -> None:
    head = ("state", "right", "wrong", "found", "missed", "precision", "recall")
    tables: dict[str, dict[str, Tally]] = {
        title: {state: Tally() for state in PERFORMANCE_STATES} for title in (JOINED_TITLE, *VIDEO_ALTERATIONS)
    }
    faults, seconds, spent = [], 0.0, 0.0
    with tempfile.TemporaryDirectory() as folder:
        for seed in ORDER_SEEDS:
            path = Path(folder) / f"{seed}.mp4"
            truth = join(in_random_order(seed), path, mirrored=seed % 2 == 0)
            started = perf_counter()
            segments = find_segments(path).segments
            spent, seconds = spent + perf_counter() - started, seconds + truth[-1].end
            faults += [f"order {seed}: {fault}" for fault in judge(tables[JOINED_TITLE], segments, truth)]
        for title, alter in VIDEO_ALTERATIONS.items():
            for name, (must, may) in labels().items():
                path = media(f"driving/{name}")
                if alter is not None:
                    frames = (alter(frame.rgb) for frame in read_video(path, fps=25, longest_side=640))
                    path = write_clip(Path(folder) / name, frames)
                segments = find_segments(path).segments
                faults += [f"{name}, {title}: {fault}" for fault in judge(tables[title], segments, must, may)]
    for title, tallies in tables.items():
        every = Tally(
            *(sum(getattr(t, one) for t in tallies.values()) for one in ("right", "wrong", "found", "missed"))
        )
        rows = [tally.row(state) for state, tally in tallies.items() if tally != Tally()]
        print(table(title if title == JOINED_TITLE else f"Real clips, {title}", head, [*rows, every.row("all")]))
    print("\n" + "\n".join(faults))
    print(f"\n{seconds / spent:.1f} seconds of video in a second. {machine()}")


if __name__ == "__main__":
    main()
