"""The moments of one's own driver: which segments of a long video hold which emotion or gesture.

from engine.portrait.moments import find_moments
for moment in find_moments("me.mp4").moments:
    print(moment.name, moment.start, moment.end)

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
from engine.portrait.moments.options import MomentsOptions
from engine.run import Run

if TYPE_CHECKING:
    from engine.portrait.moments.pipeline import Moments


def _work(inputs: Mapping[str, Given], options: BaseModel, out: Path, run: Run) -> None:
    from engine.portrait.moments.pipeline import work  # the service reads KIND alone: it stays light

    work(inputs, out, run)


def _prepare() -> None:
    from engine.portrait.moments import pipeline  # noqa: F401 - importing it is the preparation


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


def find_moments(path: str | Path, limits: Limits | None = None) -> Moments:
    """The segments of a video that hold emotions and gestures.

    Raises
    ------
    engine.errors.InputError : the video cannot be read, or shows no face; says what to do.
    FileNotFoundError : there is no such video.
    """
    from engine.portrait.moments.pipeline import moments_of
    from engine.portrait.moments.watching import measure_video_face

    return moments_of(measure_video_face(Path(path), limits or Limits()))


__all__ = ["KIND", "find_moments"]
