"""Which edges the benchmark of characters looks at, and that few of them are stretched."""

from pathlib import Path

import numpy as np

from benchmarks.character_figures.steps import wake
from benchmarks.character_figures.stretching import all_edges, stretched
from engine.character.sample import sample_picture
from engine.media.image import write_image
from engine.motion.library import CLIPS


def test_all_three_sides_of_each_triangle_are_there_once() -> None:
    square = np.array([[0, 1, 2], [0, 2, 3]])
    np.testing.assert_array_equal(all_edges(square), [[0, 1], [0, 2], [0, 3], [1, 2], [2, 3]])


def test_the_built_in_clips_stretch_few_edges(tmp_path: Path) -> None:
    """In the worst moment of each, of a person who hides nothing of themselves."""
    write_image(tmp_path / "photo.png", sample_picture(400))
    character = wake(tmp_path / "photo.png", {"triangles": 20_000}).character
    shares = {clip: stretched(character, clip) for clip in CLIPS}
    assert max(shares.values()) < 0.005, shares
    assert max(shares.values()) > 0, "somewhere between the legs skin must give"
