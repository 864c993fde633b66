"""Where ears are, by what ears measure."""

import numpy as np

from engine.character.fit.template_fit import load_human
from engine.character.shell.colours.ears import auricles
from engine.character.shell.template_mesh import template_mesh


def test_an_auricle_is_as_long_and_as_wide_as_ears_are() -> None:
    """Grown people's are 55 to 70 mm long, and half again to twice as long as wide; the template's are small."""
    mesh = template_mesh()
    places, share = load_human().space.mean[mesh.ids], auricles()
    for side in (-1, 1):
        own = places[(share > 0.5) & (side * places[:, 0] > 0)]
        _, high, deep = np.ptp(own, 0)
        assert 0.04 < high < 0.07 and 1.4 < high / deep < 2


def test_what_does_not_stand_off_the_head_is_no_auricle() -> None:
    mesh, share = template_mesh(), auricles()
    assert (share[~mesh.ear] == 0).all() and share.max() == 1
    assert (share[mesh.ear] == 0).mean() > 0.1, "the skin around is the head's"
