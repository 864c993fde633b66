"""How the photograph that acts is framed."""

from __future__ import annotations

import numpy as np
import pytest

from engine.media.video import read_video
from engine.perception.face.faces import find_faces
from engine.perception.face.head_pose import canonical_face
from engine.perception.masks.segmentation import people_confidence
from engine.performances import video
from engine.persona.collection.face_photo import FacePhoto
from engine.persona.composite.framing import framed, head_box


def photo(size: tuple[int, int], middle: tuple[float, float], eyes: float) -> FacePhoto:
    """A face whose eyes are `eyes` pixels apart about `middle`, in a picture of (width, height) that is red in its left third."""
    face = canonical_face().astype(np.float64)
    face -= face.mean(axis=0)
    mesh = face * eyes / np.linalg.norm(face[[33, 133]].mean(axis=0) - face[[263, 362]].mean(axis=0))
    mesh[:, :2] += middle
    rgb = np.full((size[1], size[0], 3), 90, np.uint8)
    rgb[:, : size[0] // 3] = (200, 30, 30)
    return FacePhoto(rgb, mesh.astype(np.float32), 0)


def test_a_large_photograph_fills_the_size_and_holds_the_head() -> None:
    target = framed(photo((1200, 1000), (500, 450), 60), (300, 400))
    assert target.size == (300, 400)
    low, high = head_box(target.mesh)
    assert (low > -1).all() and (high < np.array(target.size) + 1).all()


def test_a_face_beside_the_edge_is_framed_by_what_the_photograph_shows_and_keeps_its_depth() -> None:
    one = photo((600, 500), (70, 420), 30)
    target = framed(one, (150, 200))
    scale = target.place[0, 0]
    low = -target.place[:, 2] / scale
    assert (low > -1).all() and (low + np.array(target.size) / scale < (601, 501)).all()
    assert scale != pytest.approx(1, abs=0.1)
    np.testing.assert_allclose(np.ptp(target.mesh[:, 2]), scale * np.ptp(one.mesh[:, 2]), rtol=1e-3)


@pytest.mark.parametrize(("size", "middle"), [((112, 112), (56, 60)), ((250, 250), (125, 128)), ((700, 160), (90, 80))])
def test_a_small_photograph_is_fitted_and_keeps_its_shape(size: tuple[int, int], middle: tuple[int, int]) -> None:
    target = framed(photo(size, middle, 34), (300, 400))
    assert target.size[0] == 300 or target.size[1] == 400, "it is as large as there is room"
    assert target.size[0] <= 300 and target.size[1] <= 400
    # the mesh lies in the result where the picture's pixels went: the red third ends where it did beside the face
    red = (target.rgb[..., 0].astype(int) - target.rgb[..., 1] > 80).mean(axis=0)
    if red[0] > 0.5 and red[-1] < 0.5:
        edge = float((red > 0.5).sum()) - 0.5
        scale, shift = target.place[0, 0], target.place[0, 2]
        assert edge == pytest.approx((size[0] // 3) * scale + shift - 0.5, abs=1.5)


def test_places_of_the_mesh_are_those_of_the_picture() -> None:
    one = photo((400, 400), (200, 190), 50)
    one.rgb[:] = 0
    x, y = np.rint(one.mesh[1, :2]).astype(int)
    one.rgb[y - 2 : y + 3, x - 2 : x + 3] = 255
    target = framed(one, (300, 400))
    rows, columns = np.nonzero(target.rgb[..., 0] > 128)
    assert np.abs(np.array([columns.mean(), rows.mean()]) - target.mesh[1, :2]).max() < 1.5


def test_people_are_believed_where_the_framed_picture_shows_them() -> None:
    """Somebody at the right of a wide photograph, and somebody else at its left: what is framed knows of both, in their places."""
    one = next(iter(read_video(video("happy")))).rgb
    side = one.shape[0]
    wide = np.full((side, 2 * side, 3), 215, np.uint8)
    wide[:, :side] = wide[:, side:] = one
    right = max(find_faces(wide), key=lambda mesh: float(mesh[:, 0].mean()))
    target = framed(FacePhoto(wide, right, 0), (300, 300))
    assert target.people is not None and target.people.shape == target.rgb.shape[:2]
    alone = people_confidence(target.rgb)
    both = (target.people > 0.5) & (alone > 0.5)
    assert both.sum() > 0.8 * ((target.people > 0.5) | (alone > 0.5)).sum()
    own, others = target.face_boxes()
    assert np.abs(own[:2] - target.mesh[:, :2].min(axis=0)).max() < 1
    whole = framed(FacePhoto(wide, right, 0), (1200, 600)).face_boxes()[1]
    assert len(others) <= len(whole) == 1, "and of whoever stands beside"
