"""What locking cameras to the person is worth: a run that does without, whose cameras stay where the room has them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, TypeVar, cast

import numpy as np

from engine.avatar.capture.cameras import CaptureCameras, ClipCameras
from engine.run import Run

T = TypeVar("T")


class RoomCamerasRun(Run):
    """A run of an avatar of which nobody's sway is taken out of the cameras. How the person stands in the clip of the head is still
    told by the person: without that the head's clip would lie elsewhere."""

    def stage(
        self, name: str, function: Callable[..., T], *arguments: Any, shared: bool = False, stored: bool = True
    ) -> T:
        """As of any run; what `find_cameras` gave goes on without its lock."""
        found = super().stage(name, function, *arguments, shared=shared, stored=stored)
        return cast(T, unlocked(found)) if isinstance(found, CaptureCameras) else found


def unlocked(found: CaptureCameras) -> CaptureCameras:
    """All clips' cameras as the room has them."""
    further = tuple(None if clip is None else _in_room(clip) for clip in found.further)
    return CaptureCameras(_in_room(found.body), None if found.head is None else _in_room(found.head), further)


def _in_room(clip: ClipCameras) -> ClipCameras:
    return replace(clip, cameras=clip.room, locked=np.zeros_like(clip.locked))
