"""MediaPipe without matplotlib, until somebody draws; and its networks, which are loaded once for many pictures."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from engine.media.image import read_image
from engine.perception.face.faces import find_faces
from engine.perception.pose.body import find_body
from engine.perception.solutions import kept_networks, network

SELFIE: dict[str, Any] = {"model_selection": 0}

STEPS = """
import sys
from engine.perception.solutions import load_solution
load_solution("face_mesh")
assert "matplotlib" not in sys.modules and "matplotlib.pyplot" not in sys.modules
from mediapipe.python.solutions import drawing_utils
figure = drawing_utils.plt.figure()
import matplotlib, matplotlib.pyplot
assert isinstance(figure, matplotlib.figure.Figure)
"""
OTHERS = """
import sys
from engine.perception.solutions import UNNEEDED_MODULES, load_solution
load_solution("face_mesh")
assert not set(UNNEEDED_MODULES) & set(sys.modules)
import mediapipe
assert mediapipe.tasks.vision.FaceLandmarker.__module__.startswith("mediapipe.tasks.python.vision.")
assert mediapipe.solutions.objectron.Objectron.__module__ == "mediapipe.python.solutions.objectron"
"""


def test_matplotlib_is_imported_by_who_draws_and_nobody_else() -> None:
    subprocess.run([sys.executable, "-c", STEPS], check=True, env={"MPLBACKEND": "agg"}, timeout=60)


def test_other_parts_of_mediapipe_are_loaded_when_they_are_used() -> None:
    subprocess.run([sys.executable, "-c", OTHERS], check=True, timeout=60)


FIND = """
import numpy as np
from engine.perception.face.faces import find_faces
find_faces(np.zeros((64, 64, 3), np.uint8))
"""


def test_nothing_is_said_of_old_ways() -> None:
    done = subprocess.run([sys.executable, "-c", FIND], check=True, capture_output=True, text=True, timeout=60)
    assert "AttributeError" not in done.stderr


TOGETHER = """
from concurrent.futures import ThreadPoolExecutor
from engine.perception.solutions import load_solution
with ThreadPoolExecutor(3) as pool:
    for found in pool.map(load_solution, ("face_mesh", "pose", "selfie_segmentation")):
        assert found.__name__.startswith("mediapipe.python.solutions.")
"""


def test_threads_may_ask_at_once() -> None:
    subprocess.run([sys.executable, "-c", TOGETHER], check=True, timeout=60)


def lent() -> Any:
    return network("selfie_segmentation", "SelfieSegmentation", **SELFIE)


def test_what_is_kept_is_lent_again_to_one_at_a_time() -> None:
    with kept_networks():
        with lent() as first, lent() as second:
            assert first is not second
        with kept_networks(), lent() as again:
            assert again in (first, second)
        with lent() as still:
            assert still in (first, second), "the outer one goes on keeping"


def test_one_that_failed_is_lent_to_nobody() -> None:
    with kept_networks():
        try:
            with lent() as failed:
                raise KeyError
        except KeyError:
            pass
        with lent() as other:
            assert other is not failed


def test_a_kept_network_knows_of_nothing_that_it_saw_before(media: Callable[[str], Path]) -> None:
    """Whoever looks next finds what a new network finds, to the bit; one that follows faces does so from the beginning."""
    one, other = (read_image(media(f"fullbody/{name}.png")).rgb for name in ("man_sweater_boots", "man_mug_arm_across"))

    def seen() -> list[np.ndarray]:
        body = find_body(other)
        assert body is not None
        return [body.points, body.world, *find_faces(other)]

    anew = seen()
    find_body(one)
    assert find_faces(one)
    kept = seen()
    assert len(anew) == len(kept) == 3
    for before, after in zip(anew, kept, strict=True):
        np.testing.assert_array_equal(before, after)
