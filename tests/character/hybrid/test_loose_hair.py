"""Heads beside loose hair: the template's, with a surface of hair around it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from engine.character.hybrid.hybrid import Hybrid
from engine.character.options import CharacterOptions
from engine.character.parts.labels import HEAD_LABEL
from engine.character.pipeline import cut_all_out, find_figures, reconstruct
from engine.run import Run


class Recording(Run):
    """A run that remembers its mesh."""

    built: Any = None

    def stage(self, name: str, function: Callable[..., Any], *given: Any, **more: Any) -> Any:
        result = super().stage(name, function, *given, **more)
        if name == "build_mesh":
            self.built = result
        return result


def test_a_head_with_loose_hair_is_the_template_s_with_a_surface_of_hair(media: Callable[[str], Path]) -> None:
    """A woman with black, straight hair to her shoulders."""
    options = CharacterOptions()
    with Recording() as run:
        (figure,), (silhouette,) = cut_all_out(
            find_figures(media("fullbody/woman_white_dress.png"), options, run), None, options, run
        )
        person = reconstruct(figure, silhouette, None, options, run)
    found = run.built
    assert isinstance(found, Hybrid)
    assert (found.limbs.limb == HEAD_LABEL).any() and not (found.labels.labels == HEAD_LABEL).any()
    (hair,) = (piece for piece in found.shell.pieces if piece.colours is not None)
    assert hair.colours is not None and hair.colours.rgb.mean() < 60, "black all round"
    head = np.flatnonzero((person.labels.labels == HEAD_LABEL).any(1))
    assert abs(hair.vertices[:, 1].min() - head[0]) < 4 and hair.vertices[:, 1].max() > head[-1] - 4
