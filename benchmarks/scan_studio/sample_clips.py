"""The small clips that ship with the program (`engine.avatar.sample`): how they are made, and their truth.

python -m benchmarks.scan_studio.sample_clips [FOLDER]
"""

from __future__ import annotations

import sys
from itertools import islice
from pathlib import Path

from benchmarks.scan_studio.film import write_film
from benchmarks.scan_studio.people.template_people import TEXTURE_SIZE_TEXELS, template_subject
from benchmarks.scan_studio.scenery.room import furnished_room
from benchmarks.scan_studio.scenery.scene import Scene
from benchmarks.scan_studio.studio import Order, Take
from benchmarks.scan_studio.truth import Truth
from engine.avatar.sample import SAMPLE_FRAMES
from engine.package_data import package_folder

SAMPLE_SUBJECT = "template-a"
SAMPLE_ORDER = Order({"body": 40, "head": 32}, (216, 384))
"""Of whole films, of which the clips are the beginnings."""


def sample_truth() -> Truth:
    """What is known of both clips, frame by frame."""
    subject = template_subject(SAMPLE_SUBJECT, 16)
    return Truth(
        subject, {name: Take(name, subject, SAMPLE_ORDER).truth() for name in SAMPLE_FRAMES}, {"frames": SAMPLE_FRAMES}
    )


def write_sample_clips(folder: Path) -> None:
    """Write `body.mp4` and `head.mp4` into a folder that is there."""
    subject = template_subject(SAMPLE_SUBJECT, TEXTURE_SIZE_TEXELS)
    scene = Scene(furnished_room(SAMPLE_ORDER.seed), subject)
    for name, count in SAMPLE_FRAMES.items():
        frames = Take(name, subject, SAMPLE_ORDER).frames(scene)
        write_film(folder / f"{name}.mp4", islice(frames, count), SAMPLE_ORDER.size, SAMPLE_ORDER.film_format)


if __name__ == "__main__":
    write_sample_clips(Path(sys.argv[1]) if len(sys.argv) > 1 else package_folder("engine.avatar.sample"))
