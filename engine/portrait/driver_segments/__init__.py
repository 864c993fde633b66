"""The segments of one's own driver: which parts of a long video hold which emotion or gesture.

from engine.portrait.driver_segments import find_segments
for segment in find_segments("me.mp4").segments:
    print(segment.name, segment.start, segment.end)

In public a segment is called a moment, and there alone. The word stands in the name of the kind and its options, in
`moments.json`, and in the addresses, schemas and codes of the API (`service/drivers`). Its client, the page and the
guide have it, too.

Reading order: `watching` (a face measured frame by frame), `rest` (against itself at rest),
`perception.expression.prototypes` and `gestures` (what shows), `segments` (from where to where), `pipeline` (names,
pictures, the document).
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from pydantic import BaseModel

from engine.kind import Given, Input, Kind, Needs
from engine.media.limits import Limits
from engine.portrait.driver_segments.options import MomentsOptions
from engine.run import Run

if TYPE_CHECKING:
    from engine.portrait.driver_segments.pipeline import DriverSegments


def _work(inputs: Mapping[str, Given], options: BaseModel, out: Path, run: Run) -> None:
    from engine.portrait.driver_segments.pipeline import work  # the service reads KIND alone: it stays light

    work(inputs, out, run)


def _prepare() -> None:
    from engine.portrait.driver_segments import pipeline  # noqa: F401 - importing it is the preparation


KIND = Kind(
    name="moments",
    summary="The moments of a driving video that hold emotions are found and named.",
    inputs=(
        Input("driver", "video", "A video of one face that shows several things one after another.", serves_many=True),
    ),
    options=MomentsOptions,
    work=_work,
    prepare=_prepare,
    needs=Needs(seconds=900, memory_mb=3000, short=True),
)


def find_segments(path: str | Path, limits: Limits | None = None) -> DriverSegments:
    """The segments of a video that hold emotions and gestures.

    Raises
    ------
    engine.errors.InputError : the video cannot be read, or shows no face; says what to do.
    FileNotFoundError : there is no such video.
    """
    from engine.portrait.driver_segments.pipeline import named_segments
    from engine.portrait.driver_segments.watching import measure_video_face

    return named_segments(measure_video_face(Path(path), limits or Limits()))


__all__ = ["KIND", "find_segments"]
