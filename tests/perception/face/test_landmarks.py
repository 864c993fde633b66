"""Indices into the face mesh mean what they say: checked on the symmetric canonical face."""

from __future__ import annotations

import numpy as np
import pytest

from engine.perception.face import landmarks as lm
from engine.perception.face.head_pose import canonical_face, mirror_vertices


@pytest.fixture(scope="module")
def face():
    return canonical_face().astype(float)


def inside(point, polygon) -> bool:
    a, b = polygon, np.roll(polygon, -1, axis=0)
    crosses = (a[:, 1] > point[1]) != (b[:, 1] > point[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        x = a[:, 0] + (point[1] - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
    return bool((crosses & (point[0] < x)).sum() % 2)


def test_there_are_68_points_in_six_groups() -> None:
    groups = (lm.JAW_POINTS, lm.BROW_POINTS, lm.NOSE_POINTS, lm.EYE_POINTS, lm.OUTER_LIPS, lm.INNER_LIPS)
    assert len(lm.FIDUCIALS) == 68
    assert [i for g in groups for i in range(g.start, g.stop)] == list(range(68))


def test_named_pairs_are_averaged(face) -> None:
    points = lm.fiducials(face)
    np.testing.assert_allclose(points[3], (face[132] + face[58]) / 2)
    np.testing.assert_allclose(points[30], face[4])


def test_many_meshes_give_what_each_gives(face) -> None:
    many = np.stack([face, 2 * face, face + 1])
    np.testing.assert_allclose(lm.fiducials(many), [lm.fiducials(m) for m in many])
    np.testing.assert_allclose(lm.eye_opening(many)[1], lm.eye_opening(2 * face))
    np.testing.assert_allclose(lm.eye_distance(many), [1, 2, 1], rtol=1e-3)


def test_the_68_points_lie_on_a_face_as_the_scheme_has_them(face) -> None:
    p = lm.fiducials(face)[:, :2]
    jaw, brows, nose, eyes = p[lm.JAW_POINTS], p[lm.BROW_POINTS], p[lm.NOSE_POINTS], p[lm.EYE_POINTS]
    assert (np.diff(jaw[:, 0])[2:-2] > 0).all()  # from the picture's left to its right
    assert jaw[:, 1].argmax() == 8
    assert (np.diff(brows[:, 0]) > 0).all() and (brows[:, 1] < eyes[:, 1].min()).all()
    assert (np.diff(nose[:4, 1]) > 0).all() and np.abs(nose[:4, 0]).max() < 0.02
    assert (p[lm.OUTER_LIPS][:, 1] > nose[:, 1].max()).all()
    outer = p[lm.OUTER_LIPS]
    assert all(inside(q, outer) for q in p[lm.INNER_LIPS][[1, 2, 3, 5, 6, 7]])


def test_the_scheme_is_symmetric(face) -> None:
    """Mirrored, every one of the 68 points is another one of them; at the jaw's corner the scheme itself is uneven."""
    p = lm.fiducials(face)[:, :2]
    away = np.linalg.norm((p * [-1, 1])[:, None] - p[None], axis=2)
    assert np.delete(away.min(axis=1), (3, 13)).max() < 0.02
    assert away.min(axis=1).max() < 0.15
    assert len(set(away.argmin(axis=1).tolist())) == 68


@pytest.mark.parametrize("contour", [lm.LIPS_OUTER, lm.LIPS_INNER, lm.RIGHT_EYE, lm.LEFT_EYE, lm.FACE_OVAL])
def test_contours_are_closed_rings_without_repeats(face, contour) -> None:
    ring = face[list(contour), :2]
    steps = np.linalg.norm(np.roll(ring, -1, axis=0) - ring, axis=1)
    assert len(set(contour)) == len(contour)
    assert steps.max() < 0.35  # eye distances: no step jumps across


def test_right_is_the_person_s_own_right(face) -> None:
    """Which lies on the picture's left."""
    for part in (lm.RIGHT_EYE, lm.RIGHT_IRIS, lm.RIGHT_BROW):
        assert (face[list(part), 0] < 0).all()
    for part in (lm.LEFT_EYE, lm.LEFT_IRIS, lm.LEFT_BROW):
        assert (face[list(part), 0] > 0).all()


@pytest.mark.parametrize(
    ("right", "left"),
    [(lm.RIGHT_EYE, lm.LEFT_EYE), (lm.RIGHT_BROW, lm.LEFT_BROW), (lm.RIGHT_IRIS[:1], lm.LEFT_IRIS[:1])],
)
def test_sides_mirror_each_other_in_order(right, left) -> None:
    assert mirror_vertices()[list(right)].tolist() == list(left)


def test_upper_lid_is_the_contour_s_eighth(face) -> None:
    for contour in (lm.RIGHT_EYE, lm.LEFT_EYE):
        outer, inner = face[contour[0]], face[contour[8]]
        upper, lower = face[list(contour[1:8])], face[list(contour[9:])]
        assert abs(outer[0]) > abs(inner[0])
        assert upper[:, 1].mean() < lower[:, 1].mean()


def test_iris_lies_in_its_eye_centre_first(face) -> None:
    for contour, iris in ((lm.RIGHT_EYE, lm.RIGHT_IRIS), (lm.LEFT_EYE, lm.LEFT_IRIS)):
        assert inside(face[iris[0], :2], face[list(contour), :2])
        np.testing.assert_allclose(face[list(iris[1:]), :2].mean(axis=0), face[iris[0], :2], atol=0.02)


def test_openings_by_hand(face) -> None:
    mesh = face.copy()
    mesh[61], mesh[291] = (-1, 1, 0), (1, 1, 0)
    mesh[13], mesh[14] = (0, 0.8, 0), (0, 1.2, 0)
    assert lm.mouth_opening(mesh) == pytest.approx(0.2)
    mesh[[33, 133]] = (-1, 0, 0), (-0.5, 0, 0)
    mesh[[159, 158, 160]] = (-0.75, -0.1, 0)
    mesh[[145, 153, 144]] = (-0.75, 0.1, 0)
    assert lm.eye_opening(mesh)[0] == pytest.approx(0.4)


def test_openings_do_not_depend_on_place_size_and_roll(face) -> None:
    a = 0.7
    turned = 37 * face @ np.array([[np.cos(a), np.sin(a), 0], [-np.sin(a), np.cos(a), 0], [0, 0, 1]]) + 100
    assert lm.mouth_opening(turned) == pytest.approx(lm.mouth_opening(face))
    assert lm.eye_opening(turned) == pytest.approx(lm.eye_opening(face))
    assert lm.eye_distance(turned) == pytest.approx(37 * lm.eye_distance(face))
