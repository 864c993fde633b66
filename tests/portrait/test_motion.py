"""How much the plane counts beside the head turned in space."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import placed

from engine.perception.landmarks import FACE_OVAL
from engine.portrait.motion import PLANE_SHARE, plane_share


def test_a_frontal_face_moves_in_space_alone() -> None:
    assert plane_share(placed(60, (150, 140))).max() == 0


@pytest.mark.parametrize(("yaw", "share"), [(6.5, 0.5), (10, 1), (25, 1)])
def test_inside_a_turned_face_the_plane_counts_and_never_on_its_contour(yaw: float, share: float) -> None:
    face = placed(60, (150, 140), yaw=yaw)
    counts = plane_share(face)
    assert np.abs(counts[list(FACE_OVAL)]).max() < 0.02
    assert counts[[1, 133, 362, 13, 14]] == pytest.approx(PLANE_SHARE * share, abs=0.03)
