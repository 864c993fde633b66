"""MediaPipe without matplotlib, until somebody draws."""

from __future__ import annotations

import subprocess
import sys

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
from engine.perception.faces import find_faces
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
