"""`python -m engine.performances render NAME ...`: renders performances into the package, or into `--folder`, and the
posters that show them.

Takes a second or two a frame; `--proof` renders a rough one in a quarter of the time.
"""

from __future__ import annotations

from itertools import islice
from pathlib import Path

import click
import cv2
import numpy as np

from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.media.image import write_image
from engine.media.video import read_video
from engine.performances.catalogue import (
    PERFORMANCE_FPS,
    POSTER_SIDE_PIXELS,
    VIDEO_FOLDER,
    names,
    performance,
    scored,
    video,
)
from engine.performances.modelling.actor import build_actor
from engine.performances.rendering.filming import film
from engine.performances.rendering.lighting import lamps
from engine.performances.rendering.studio import FRAME_SIDE_PIXELS, HAIR_LAMPS
from engine.performances.scores.score import SCORES

VIDEO_CRF = 16
"""H.264 quality: without visible loss, all together below 8 MB."""


@click.group()
def main() -> None:
    """Make the built-in performances."""


@main.command()
@click.argument("chosen", nargs=-1, type=click.Choice([one.name for one in scored()]))
@click.option("--folder", type=click.Path(path_type=Path), default=VIDEO_FOLDER, help="Where the videos go.")
@click.option("--proof", is_flag=True, help="Rough and quick.")
def render(chosen: tuple[str, ...], folder: Path, proof: bool) -> None:
    """Render the performances CHOSEN, or all."""
    folder.mkdir(parents=True, exist_ok=True)
    actor = build_actor(lamps(HAIR_LAMPS))
    for name in chosen or [one.name for one in scored()]:
        poses = [
            SCORES[name](index / PERFORMANCE_FPS) for index in range(round(performance(name).seconds * PERFORMANCE_FPS))
        ]
        frames = film(actor, poses, 1, 0.35) if proof else film(actor, poses)
        with VideoWriter(
            VideoTarget(folder / f"{name}.mp4", (FRAME_SIDE_PIXELS, FRAME_SIDE_PIXELS), PERFORMANCE_FPS, crf=VIDEO_CRF)
        ) as writer:
            for index, frame in enumerate(frames):
                writer.write(frame)
                click.echo(f"\r{name}: {index + 1} of {len(poses)}", nl=index + 1 == len(poses))
        _photograph(name, folder)


@main.command()
@click.argument("chosen", nargs=-1, type=click.Choice(names()))
@click.option("--folder", type=click.Path(path_type=Path), default=VIDEO_FOLDER, help="Where the videos are.")
def posters(chosen: tuple[str, ...], folder: Path) -> None:
    """Take the posters of the performances CHOSEN, or all, from their videos."""
    for name in chosen or names():
        _photograph(name, folder)


def _photograph(name: str, folder: Path) -> None:
    index = performance(name).poster_frame
    frame = next(islice(read_video(video(name, folder)), index, None)).rgb
    small = cv2.resize(frame, (POSTER_SIDE_PIXELS, POSTER_SIDE_PIXELS), interpolation=cv2.INTER_AREA)
    write_image(folder / f"{name}.jpg", np.asarray(small, np.uint8), quality=88)


if __name__ == "__main__":
    main()
