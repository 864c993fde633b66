"""A real job kind, small enough for tests: it reads a picture and leaves a few artifacts, in stages.

Its options let it misbehave in the ways that inputs can make a job misbehave.
"""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from engine.errors import InputError
from engine.kind import Candidates, Given, Input, Kind, Needs
from engine.run import Run
from engine.run_report import write_report


class TinyOptions(BaseModel):
    """How to behave."""

    model_config = ConfigDict(extra="forbid")

    seconds: float = Field(0.0, ge=0)
    """How long the second stage takes."""
    rest_once: bool = False
    """Take that long at the first attempt only, so that a test may break it off whenever it comes to it."""
    polls: bool = True
    """Whether it looks for cancellation meanwhile."""
    level: float = 0.0
    """Added to what is measured; a correction."""
    crash: (
        Literal["segv", "abort", "kill", "exit", "memory", "disk", "file", "bug", "refuse", "hostile_name", "link"]
        | None
    ) = None
    crash_once: bool = False
    """Crash at the first attempt only (there is a file in the stages' folder from then on)."""


@dataclass(frozen=True)
class Mean:
    """The mean of a file's bytes."""

    value: float
    spectrum: np.ndarray


def measure(image: Path) -> Mean:
    data = np.frombuffer(image.read_bytes(), np.uint8)
    return Mean(float(data.mean()), np.bincount(data, minlength=256))


def rest(seconds: float, polls: bool, tick: object) -> Mean:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        time.sleep(0.02)
        if polls:
            tick(1 - (end - time.monotonic()) / seconds, "resting")  # type: ignore[operator]
    return Mean(0.0, np.zeros(1))


def misbehave(how: str | None, out: Path) -> None:
    match how:
        case "segv":
            os.kill(os.getpid(), signal.SIGSEGV)
        case "abort":
            os.abort()
        case "kill":
            os.kill(os.getpid(), signal.SIGKILL)
        case "exit":
            os._exit(3)
        case "memory":
            _ = [np.ones(1 << 24) for _ in range(10_000)]
        case "disk":
            with (out / "huge.bin").open("wb") as file:
                while True:
                    file.write(b"x" * 1_000_000)
                    file.flush()
                    time.sleep(0.005)
        case "file":
            with (out / "huge.bin").open("wb") as file:
                file.truncate(1 << 40)
        case "bug":
            raise ZeroDivisionError
        case "refuse":
            raise InputError("no_face", "No face was found: choose another picture.", ("landmarks",), {"faces": []})
        case "hostile_name":
            (out / "a b;c\n.html").write_text("<script>")
        case "link":
            (out / "secret.json").symlink_to("/etc/hostname")


def work(inputs: Mapping[str, Given], options: BaseModel, out: Path, run: Run) -> None:
    assert isinstance(options, TinyOptions)
    image = inputs.get("image") or inputs["earlier"]
    assert isinstance(image, Path)
    run.plan({"measure": 0.2, "rest": 0.7, "write": 0.1})
    mean = run.stage("measure", measure, image)
    (out / "preview.jpg").write_bytes(image.read_bytes())
    run.publish(out / "preview.jpg")
    crashed = out.parent.parent / "stages" / "crashed"
    if options.crash_once and not crashed.exists():
        crashed.touch()
        misbehave(options.crash, out)
    elif not options.crash_once:
        misbehave(options.crash, out)
    again = options.rest_once and out.parent.name != "attempt-1"
    seconds = 0.0 if again else options.seconds
    run.stage("rest", rest, seconds, options.polls, run.tick, stored=False)
    with run.timed("write"):
        (out / "spectrum.json").write_text(str(mean.spectrum.tolist()))
        (out / "animation.mp4").write_bytes(bytes(range(256)) * 400)
        size = len(image.read_bytes())
        driver = inputs.get("driver")
        asked = {"bytes": size, "driver": driver.name if isinstance(driver, Path) else None}
        if isinstance(mask := inputs.get("mask"), Path):
            asked["mask"] = mask.stat().st_size
        if (cores := len(os.sched_getaffinity(0))) < (os.cpu_count() or 1):
            asked["cores"] = cores
        if isinstance(driver, Candidates):
            asked["candidates"] = {name: path.stat().st_size for name, path in driver.files.items()}
        write_report(
            out / "report.json", "tiny", run, asked, {"mean": mean.value + options.level, "reused": len(run.reused)}
        )


KIND = Kind(
    name="tiny",
    summary="Measures a picture.",
    inputs=(
        Input("image", "image", "a picture"),
        Input("driver", "video", "a video, or the name of a driver", required=False, library="performances"),
        Input("mask", "image", "a picture that covers the other", required=False, corrects=True),
    ),
    options=TinyOptions,
    work=work,
    correctable=("level",),
)

OTHER = replace(KIND, name="other")
SHORT = replace(KIND, name="short", needs=Needs(seconds=600, memory_mb=1500, cores=1, short=True))
BRIEF = replace(KIND, name="brief", needs=Needs(seconds=4, short=True))


def measure_above(image: Path, level: float) -> Mean:
    mean = measure(image)
    return replace(mean, value=mean.value + level)


def measure_person(inputs: Mapping[str, Given], options: BaseModel, out: Path, run: Run) -> None:
    """Reads its picture in a stored stage only, whose output is as large as the picture."""
    assert isinstance(options, TinyOptions)
    mean = run.stage("measure", measure_above, inputs["image"], options.level)
    misbehave(options.crash, out)
    (out / "spectrum.json").write_text(str(mean.spectrum.tolist()))
    write_report(out / "report.json", "person", run, {}, {"mean": mean.value, "reused": len(run.reused)})


PERSON = replace(
    KIND,
    name="person",
    inputs=(Input("image", "image", "a picture of somebody", personal=True),),
    work=measure_person,
)
"""Whose picture an operator may have erased once it was measured."""
FOLLOWING = replace(
    KIND,
    name="following",
    inputs=(
        Input("image", "image", "a picture", spared_by_input="earlier"),
        Input("earlier", "image", "the picture of an earlier job", required=False, artifact="preview.jpg"),
    ),
)
"""Takes what an earlier job of it left."""
TOGETHER = replace(
    FOLLOWING,
    name="together",
    inputs=tuple(replace(item, erased_together=item.name == "earlier") for item in FOLLOWING.inputs),
)
"""Shows whom the earlier job shows, and is erased with it."""
