"""What moves feet: toes bend as a whole, from the ball on."""

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.body.rig import HUMAN_RIG, Rig
from engine.body.template import load_rig, load_template

SIDES = ("Left", "Right")


def share(rig: Rig, name: str) -> NDArray[np.float64]:
    """How much of each vertex (V,) a joint moves."""
    return np.where(rig.bones == rig.index(name), rig.weights, 0).sum(1).astype(np.float64)


@pytest.mark.parametrize("name", ["mixamo", HUMAN_RIG])
@pytest.mark.parametrize("side", SIDES)
def test_toes_are_moved_by_their_joint_alone_and_heels_not_at_all(name: str, side: str) -> None:
    rig = load_rig(name)
    toes, foot = share(rig, f"{side}ToeBase"), share(rig, f"{side}Foot")
    along = load_template().vertices[:, 2]
    own = toes + foot > 0.99
    heel, tip = along[own].min(), along[own].max()
    way = (along - heel) / (tip - heel)
    assert (toes[own & (way > 0.95)] > 0.99).all()
    assert not toes[own & (way < 0.5)].any()
    bins = [np.median(toes[own & (way >= a) & (way < a + 0.05)]) for a in np.arange(0.5, 1, 0.05)]
    assert (np.diff(bins) >= -0.25).all(), "the further forward, the more, but for gaps between toes"


@pytest.mark.parametrize("side", SIDES)
def test_weights_sum_to_one_strongest_first(side: str) -> None:
    rig = load_rig(HUMAN_RIG)
    own = share(rig, f"{side}ToeBase") > 0
    assert own.sum() > 500
    np.testing.assert_allclose(rig.weights[own].sum(1), 1, atol=1e-5)
    assert (np.diff(rig.weights[own], axis=1) <= 1e-6).all()
