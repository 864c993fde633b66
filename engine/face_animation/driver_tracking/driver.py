"""The driving video: one of its faces is followed, and what is wrong with it is said in the words of whoever gave it.

The analysis is kept by content, so that a driver seen before costs no decoding and no tracking.
"""

from __future__ import annotations

from collections.abc import Callable

from engine.errors import InputError
from engine.media.excerpt import Excerpt
from engine.perception.face_track.track import FaceTrack, NoFaceSeen, NoSuchFace, track_face


def track_driver(
    excerpt: Excerpt,
    face_index: int = 0,
    tick: Callable[[float], None] = lambda fraction: None,
    warn: Callable[[str, str], None] = lambda code, message: None,
) -> FaceTrack:
    """Analyse a driving video, by the largest face that its first frame with any shows, or the `face_index`-th.

    Raises
    ------
    InputError : `no_face_in_driver` where no frame shows a face, `driver_face_out_of_range` where there are fewer, and
    what reading the video may raise.
    """
    try:
        track = track_face(excerpt, face_index, tick, warn)
    except NoFaceSeen:
        raise InputError(
            "no_face_in_driver",
            "No face was found in the driving video: use one that shows a face from the front.",
            ("driver",),
        ) from None
    except NoSuchFace as error:
        raise InputError(
            "driver_face_out_of_range",
            f"The driver shows {error.faces} face(s): driver_face_index counts from 0.",
            ("driver_face_index",),
        ) from None
    if len(track.faces) > 1:
        warn(
            "several_faces_in_driver",
            f"The driver shows {len(track.faces)} faces: driver_face_index chooses one, 0 is the largest.",
        )
    if not track.found.all():
        lost = len(track) - int(track.found.sum())
        warn(
            "driver_face_lost",
            f"The driver's face was not seen in {lost} of {len(track)} frames: it holds still there.",
        )
    return track
