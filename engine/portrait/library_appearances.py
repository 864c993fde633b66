"""`python -m engine.portrait.library_appearances`: writes down what the built-in performances look like.

All show one figure in one light: its proportions, light and palette stand once, as seen in the neutral pose.
"""

from __future__ import annotations

import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.media.limits import Limits
from engine.performances import names, video
from engine.performances.catalogue import VIDEO_FOLDER
from engine.portrait.appearance import Appearance, appearance_of_driver

FIGURE_PERFORMANCE = "idle"
"""The performance in which the figure itself is measured: it moves least."""


def measure_library() -> dict[str, Any]:
    """The document that is kept beside the videos."""
    seen = {name: appearance_of_driver(video(name), Limits()) for name in names()}
    figure: Appearance = seen[FIGURE_PERFORMANCE]
    return {
        "figure": {key: _rounded(getattr(figure, key)) for key in ("proportions", "light", "palette")},
        "performances": {
            name: {"turn": round(one.turn, 2), "expressions": _rounded(one.expressions)} for name, one in seen.items()
        },
    }


def _rounded(values: NDArray[np.float32]) -> Any:
    return np.round(values.astype(float), 4).tolist()


if __name__ == "__main__":
    (VIDEO_FOLDER / "appearances.json").write_text(json.dumps(measure_library(), separators=(",", ":")) + "\n")
