"""The segments of a driving video, stage by stage: watch it, find the segments, take a picture of each."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.export.still import write_thumbnail
from engine.kind import Given
from engine.media.limits import Limits
from engine.media.video import read_video
from engine.perception.expression.measures import REST_SPREAD
from engine.performances import State
from engine.performances.catalogue import POSTER_SIDE_PIXELS, Strength
from engine.portrait.driver_segments.rest import own_rest
from engine.portrait.driver_segments.segments import Segment, detect_segments
from engine.portrait.driver_segments.watching import (
    MAX_WATCHED_SIDE_PIXELS,
    WATCHED_FPS,
    FaceMeasurements,
    measure_video_face,
)
from engine.run import Run
from engine.run_report import write_report

STAGES = {"watch": 12.0, "find_segments": 0.5, "posters": 2.0}
"""The stages and their usual share of the time."""

POSTER_MARGIN_SHARE = 0.35
"""How much of the face's height a picture shows around it on every side."""


@dataclass(frozen=True)
class DriverSegment:
    """A segment of a video that holds a state.

    name : the state's, with a number from the second best on.
    start, end, apex : seconds from the video's beginning; the face is at rest at `start` and `end`, and the state at
        its height at `apex`.
    score : how sure it is, in [0, 1].
    """

    name: str
    state: State
    strength: Strength
    start: float
    end: float
    apex: float
    score: float

    @property
    def seconds(self) -> float:
        return round(self.end - self.start, 3)

    @property
    def poster(self) -> str:
        """The name of its picture."""
        return f"{self.name}.jpg"


@dataclass(frozen=True)
class DriverSegments:
    """All segments of a video, in the order of the states, the best of each first; `rest`: when the face is most at
    rest, in seconds."""

    rest: float
    segments: tuple[DriverSegment, ...]


def work(inputs: Mapping[str, Given], out: Path, run: Run) -> None:
    """Find the segments of `inputs["driver"]`; leaves `moments.json`, a picture of each, `poster.jpg` (the face at
    rest) and `report.json` in `out`."""
    driver = inputs["driver"]
    assert isinstance(driver, Path)
    run.plan(STAGES)
    watched = run.stage("watch", measure_video_face, driver, run.limits, run.tick, shared=True)
    with run.timed("find_segments"):
        found = named_segments(watched)
    with run.timed("posters"):
        wanted = {"poster.jpg": found.rest} | {one.poster: one.apex for one in found.segments}
        for done, (name, time) in enumerate(wanted.items()):
            write_thumbnail(out / name, picture(driver, time, watched, run.limits), synthetic=False)
            run.tick((done + 1) / len(wanted))
    write_segments(out / "moments.json", found, watched)
    seen = float(watched.found.mean())
    inputs_ = {"seconds": round(watched.seconds, 3), "fps": WATCHED_FPS, "frames": len(watched.found)}
    write_report(out / "report.json", "moments", run, inputs_, {"driver_face_share": seen})


def named_segments(watched: FaceMeasurements) -> DriverSegments:
    """The segments of a video that was watched."""
    rest = own_rest(watched.values[watched.found])
    apart = np.linalg.norm((watched.values - rest) / REST_SPREAD, axis=1)
    segments = detect_segments(watched.values, watched.found, rest, WATCHED_FPS)
    at_rest = int(np.argmin(np.where(watched.found, apart, np.inf)))
    return DriverSegments(at_rest / WATCHED_FPS, tuple(_named(segments, watched.seconds)))


def write_segments(path: Path, found: DriverSegments, watched: FaceMeasurements) -> None:
    """Write `moments.json`."""
    listed = [{**asdict(one), "seconds": one.seconds, "poster": one.poster} for one in found.segments]
    document = {"seconds": round(watched.seconds, 3), "rest": round(found.rest, 3), "moments": listed}
    path.write_text(json.dumps(document, indent=2) + "\n")


def picture(path: Path, time: float, watched: FaceMeasurements, limits: Limits) -> NDArray[np.uint8]:
    """The face at a time of the video and as much around it as there is, (256, 256, 3)."""
    place = min(round(time * WATCHED_FPS), len(watched.found) - 1)
    span = (max(time - 0.25 / WATCHED_FPS, 0.0), time + 1 / WATCHED_FPS)
    frame = next(
        iter(read_video(path, fps=WATCHED_FPS, trim=span, limits=limits, longest_side=MAX_WATCHED_SIDE_PIXELS))
    ).rgb
    left, top, right, bottom = watched.boxes[place]
    half = (np.array(frame.shape[1::-1]) - 1) / 2
    reach = min((0.5 + POSTER_MARGIN_SHARE) * max(right - left, bottom - top), *half)
    centre = np.clip([(left + right) / 2, (top + bottom) / 2], reach, 2 * half - reach)
    scale = POSTER_SIDE_PIXELS / (2 * reach)
    shift = (POSTER_SIDE_PIXELS - 1) / 2 - scale * centre
    moved = np.array([[scale, 0, shift[0]], [0, scale, shift[1]]])
    drawn = cv2.warpAffine(
        frame, moved, (POSTER_SIDE_PIXELS, POSTER_SIDE_PIXELS), flags=cv2.INTER_AREA, borderMode=cv2.BORDER_REPLICATE
    )
    return np.asarray(drawn, np.uint8)


def _named(segments: list[Segment], seconds: float) -> list[DriverSegment]:
    named: list[DriverSegment] = []
    for one in segments:
        number = 1 + sum(other.state == one.state for other in named)
        named.append(
            DriverSegment(
                name=one.state if number == 1 else f"{one.state}-{number}",
                state=one.state,
                strength=one.strength,
                start=round(one.first / WATCHED_FPS, 3),
                end=round(min((one.last + 1) / WATCHED_FPS, seconds), 3),
                apex=round(one.apex / WATCHED_FPS, 3),
                score=round(one.score, 3),
            )
        )
    return named
