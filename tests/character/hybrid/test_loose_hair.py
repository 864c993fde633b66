"""Heads beside loose hair: the relief's of `auto`, the template's with a shell of hair of a hybrid that is asked for."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal

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


def built(photo: Path, surface: Literal["auto", "hybrid"]) -> Hybrid:
    options = CharacterOptions(surface=surface)
    with Recording() as run:
        (figure,), (silhouette,) = cut_all_out(find_figures(photo, options, run), None, options, run)
        reconstruct(figure, silhouette, None, options, run)
    assert isinstance(run.built, Hybrid)
    return run.built


def test_what_a_head_beside_loose_hair_is(media: Callable[[str], Path]) -> None:
    """A woman with black, straight hair to her shoulders."""
    relief, shell = (built(media("fullbody/woman_white_dress.png"), surface) for surface in ("auto", "hybrid"))
    assert (relief.labels.labels == HEAD_LABEL).any() and not (relief.limbs.limb == HEAD_LABEL).any()
    assert not any(piece.colours for piece in relief.shell.pieces)
    assert (shell.limbs.limb == HEAD_LABEL).any() and not (shell.labels.labels == HEAD_LABEL).any()
    (hair,) = (piece for piece in shell.shell.pieces if piece.colours is not None)
    assert hair.colours is not None and hair.colours.rgb.mean() < 60, "black all round"
    head = np.flatnonzero((relief.labels.labels == HEAD_LABEL).any(1))
    assert abs(hair.vertices[:, 1].min() - head[0]) < 4 and hair.vertices[:, 1].max() > head[-1] - 4
