"""The shipped videos, looked at as the portrait system looks at them: by the face mesh, frame by frame.

The measures are those on which real drivers were compared with them: openings and distances in units of the
distance between the eyes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.media.video import probe_video, read_video
from engine.perception.faces import FaceTracker
from engine.performances import catalogue, names, video
from engine.performances.actor import Actor, build_actor, stage
from engine.performances.catalogue import FPS
from engine.performances.figure import Pose
from engine.performances.lighting import lamps
from engine.performances.studio import HAIR_LAMPS, photograph

MEBIBYTE = 2**20


@dataclass(frozen=True)
class Watched:
    """A performance's frames (T, 512, 512, 3) and the mesh found on each (T, 478, 3)."""

    frames: NDArray[np.uint8]
    mesh: NDArray[np.float32]

    def between(self, a: int, b: int) -> NDArray[np.float32]:
        return np.linalg.norm(self.mesh[:, a, :2] - self.mesh[:, b, :2], axis=1)

    @property
    def eye_distance(self) -> float:
        eyes = (self.mesh[:, [33, 362], :2] + self.mesh[:, [133, 263], :2]) / 2
        return float(np.median(np.linalg.norm(eyes[:, 1] - eyes[:, 0], axis=1)))

    @property
    def mouth_opening(self) -> NDArray[np.float32]:
        return self.between(13, 14) / self.eye_distance

    @property
    def mouth_width(self) -> NDArray[np.float32]:
        return self.between(61, 291) / self.eye_distance

    @property
    def brow_height(self) -> NDArray[np.float32]:
        return (self.between(105, 133) + self.between(334, 362)) / 2 / self.eye_distance

    @property
    def eye_openings(self) -> NDArray[np.float32]:
        """(T, 2): lid distance over the eye's width."""
        left = (self.between(386, 374) + self.between(385, 380)) / 2 / self.between(362, 263)
        right = (self.between(159, 145) + self.between(158, 153)) / 2 / self.between(33, 133)
        return np.stack([left, right], 1)


@pytest.fixture(scope="module")
def watched() -> dict[str, Watched]:
    found = {}
    for name in names():
        frames = np.stack([frame.rgb.copy() for frame in read_video(video(name))])
        with FaceTracker() as tracker:
            meshes = [tracker(frame) for frame in frames]
        assert all(len(mesh) == 1 for mesh in meshes), f"{name}: the face was lost or doubled"
        found[name] = Watched(frames, np.stack([mesh[0] for mesh in meshes]))
    return found


def test_the_videos_are_what_the_catalogue_says() -> None:
    for entry in catalogue():
        info = probe_video(video(entry.name))
        assert (info.width, info.height, info.fps) == (512, 512, FPS)
        assert info.frames == round(entry.seconds * FPS)
        assert not info.has_sound
    assert sum(video(name).stat().st_size for name in names()) < 3 * MEBIBYTE


def test_unknown_performances_are_refused() -> None:
    with pytest.raises(KeyError, match="choose one of idle"):
        video("rage")


@pytest.mark.parametrize("name", names())
def test_the_face_is_large_and_frontal(watched: dict[str, Watched], name: str) -> None:
    mesh = watched[name].mesh
    width = np.ptp(mesh[0, :, 0])
    assert 210 < width < 280
    depth = np.abs(mesh[:, 234, 2] - mesh[:, 454, 2]) / width
    assert depth.max() < 0.25  # turned by less than some ten degrees
    assert mesh[..., :2].min() > 5 and mesh[..., :2].max() < 507


@pytest.mark.parametrize("name", names())
def test_all_start_and_end_in_the_same_neutral_face(watched: dict[str, Watched], name: str) -> None:
    neutral = watched["idle"].mesh[0, :, :2]
    for index in (0, -1):
        away = np.linalg.norm(watched[name].mesh[index, :, :2] - neutral, axis=1)
        assert away.mean() < 2.0
    assert watched[name].mouth_opening[[0, -1]].max() < 0.02
    assert watched[name].eye_openings[[0, -1]].min() > 0.24


@pytest.mark.parametrize("name", names())
def test_blinks_shut_both_eyes(watched: dict[str, Watched], name: str) -> None:
    openings = watched[name].eye_openings
    assert openings.min(0).max() < 0.09
    shut = (openings < 0.12).all(1)
    blinks = np.flatnonzero(np.diff(shut.astype(int)) == 1)
    assert len(blinks) == {"idle": 2, "happy": 2, "surprise": 1}[name]
    assert shut.sum() / len(blinks) < 0.3 * FPS


@pytest.mark.parametrize("name", names())
def test_the_mouth_moves_smoothly(watched: dict[str, Watched], name: str) -> None:
    """The man who grins in a real driver opens his mouth by 0.10 from one frame (of 25) to the next at most."""
    assert np.abs(np.diff(watched[name].mouth_opening)).max() < 0.10
    assert np.abs(np.diff(watched[name].mouth_width)).max() < 0.08


def test_happy_is_as_broad_as_a_real_grin(watched: dict[str, Watched]) -> None:
    """Real: the mouth grows from 0.80 to 1.15 and opens by 0.10 to 0.26; the eyes narrow by a sixth."""
    happy = watched["happy"]
    apex = slice(round(1.3 * FPS), round(2.2 * FPS))
    assert np.median(happy.mouth_width[apex]) / happy.mouth_width[0] > 1.28
    assert 0.08 < np.median(happy.mouth_opening[apex]) < 0.30
    assert np.median(happy.eye_openings[apex]) < 0.93 * np.median(happy.eye_openings[:6])
    corners = happy.mesh[:, [61, 291], 1].mean(1) - happy.mesh[:, [33, 263], 1].mean(1)
    assert np.median(corners[apex]) < corners[0] - 0.10 * happy.eye_distance


def test_surprise_opens_eyes_and_mouth_and_lifts_the_brows(watched: dict[str, Watched]) -> None:
    """Real: lids from 0.33 to 0.40, mouth 0.28 and more, brows up by 0.06 to 0.10."""
    surprise = watched["surprise"]
    apex = slice(round(0.9 * FPS), round(1.4 * FPS))
    assert np.median(surprise.mouth_opening[apex]) > 0.24
    assert np.median(surprise.eye_openings[apex]) > 1.15 * np.median(surprise.eye_openings[:5])
    assert np.median(surprise.brow_height[apex]) > surprise.brow_height[0] + 0.05


def test_the_eyes_widen_before_the_jaw_drops(watched: dict[str, Watched]) -> None:
    surprise = watched["surprise"]
    lids = surprise.eye_openings.mean(1)
    widened = np.argmax(lids > lids[:5].mean() + 0.5 * (lids.max() - lids[:5].mean()))
    opened = np.argmax(surprise.mouth_opening > 0.5 * surprise.mouth_opening.max())
    assert widened < opened


def test_furrows_come_with_the_brows(watched: dict[str, Watched]) -> None:
    """The forehead of the surprised face has more contrast between its rows than the neutral one's."""
    surprise = watched["surprise"]

    def rows(index: int) -> float:
        left, right = surprise.mesh[index, 105, :2], surprise.mesh[index, 334, :2]
        top = surprise.mesh[index, 10, 1]
        patch = surprise.frames[index, int(top) : int(min(left[1], right[1])) - 6, int(left[0]) : int(right[0])]
        profile = patch.astype(float).mean((1, 2))
        return float(np.abs(np.diff(profile, 2)).mean())

    assert rows(round(1.1 * FPS)) > 1.5 * rows(0)


def test_idle_has_no_seam(watched: dict[str, Watched]) -> None:
    frames = watched["idle"].frames.astype(np.float32)
    steps = np.abs(np.diff(frames, axis=0)).mean((1, 2, 3))
    assert np.abs(frames[0] - frames[-1]).mean() <= 1.15 * steps.max()  # the first frame is coded on its own
    assert np.abs(frames[0] - frames[-1]).mean() < 3 * np.median(steps)


def test_idle_is_never_quite_still(watched: dict[str, Watched]) -> None:
    mesh = watched["idle"].mesh[..., :2]
    nose = mesh[:, 4]
    assert 2 < np.ptp(nose, axis=0).max() < 25


def test_the_background_holds_still(watched: dict[str, Watched]) -> None:
    corner = watched["surprise"].frames[:, :40, :40].astype(float)
    assert corner.std(0).max() < 1.5


@pytest.fixture(scope="module")
def actor() -> Actor:
    return build_actor(lamps(HAIR_LAMPS))


def test_the_shipped_videos_are_what_the_studio_makes(watched: dict[str, Watched], actor: Actor) -> None:
    """The first frame, rendered anew: whoever changes the actor has to render the videos again."""
    fresh = photograph(actor, stage(actor, Pose())).astype(float)
    assert np.abs(fresh - watched["surprise"].frames[0]).mean() < 1.5


def test_skin_is_lit_from_the_sitters_right(watched: dict[str, Watched]) -> None:
    """The key stands at the left of the picture: that cheek is the brighter one."""
    happy = watched["happy"]
    cheeks = happy.mesh[0, [117, 346], :2].astype(int)
    bright, dark = (happy.frames[0, y - 6 : y + 7, x - 6 : x + 7].mean() for x, y in cheeks)
    assert bright > 1.08 * dark
