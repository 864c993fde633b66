"""`python -m engine.performances render NAME ...`: renders performances into the package, or into `--folder`.

Takes some seconds a frame; `--proof` renders a rough one in a quarter of the time.
"""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np
from numpy.typing import NDArray

from engine.export.video import VideoWriter
from engine.performances.actor import Actor, build_actor, stage
from engine.performances.catalogue import FPS, VIDEOS, names, performance
from engine.performances.lighting import lamps
from engine.performances.score import SCORES
from engine.performances.studio import HAIR_LAMPS, SAMPLES, SIZE, photograph

CRF = 16
"""H.264 quality: without visible loss, the three together well below 3 MB."""


def frame(actor: Actor, name: str, index: int, proof: bool = False) -> NDArray[np.uint8]:
    """One frame of a performance, (SIZE, SIZE, 3) uint8."""
    scene = stage(actor, SCORES[name](index / FPS))
    return photograph(actor, scene, samples=1 if proof else SAMPLES, detail=0.35 if proof else 1.0)


@click.group()
def main() -> None:
    """Make the built-in performances."""


@main.command()
@click.argument("chosen", nargs=-1, type=click.Choice(names()))
@click.option("--folder", type=click.Path(path_type=Path), default=VIDEOS, help="Where the videos go.")
@click.option("--proof", is_flag=True, help="Rough and quick.")
def render(chosen: tuple[str, ...], folder: Path, proof: bool) -> None:
    """Render the performances CHOSEN, or all."""
    folder.mkdir(parents=True, exist_ok=True)
    actor = build_actor(lamps(HAIR_LAMPS))
    for name in chosen or names():
        count = round(performance(name).seconds * FPS)
        with VideoWriter(folder / f"{name}.mp4", (SIZE, SIZE), FPS, crf=CRF) as writer:
            for index in range(count):
                writer.write(frame(actor, name, index, proof))
                click.echo(f"\r{name}: {index + 1} of {count}", nl=index + 1 == count)


if __name__ == "__main__":
    main()
