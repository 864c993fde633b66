"""MediaPipe without matplotlib, until somebody draws."""

from __future__ import annotations

import subprocess
import sys

STEPS = """
import sys
from engine.perception.solutions import solution
solution("face_mesh")
assert "matplotlib" not in sys.modules and "matplotlib.pyplot" not in sys.modules
from mediapipe.python.solutions import drawing_utils
figure = drawing_utils.plt.figure()
import matplotlib, matplotlib.pyplot
assert isinstance(figure, matplotlib.figure.Figure)
"""


def test_matplotlib_is_imported_by_who_draws_and_nobody_else() -> None:
    subprocess.run([sys.executable, "-c", STEPS], check=True, env={"MPLBACKEND": "agg"}, timeout=60)
