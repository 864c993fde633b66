"""The process that makes a live portrait, as the service sees it: who starts it is given to the application.

Messages in both directions: one byte that says what it is, and what it holds.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

FRAME_TAG, COMMAND_TAG, EVENT_TAG = b"F", b"C", b"E"
"""A frame: four bytes of its number (big-endian) and a picture. A command to the process, an event of it: JSON."""


@dataclass(frozen=True)
class LiveOrder:
    """What a process is to do: `image`, the target; `options` of `engine.portrait.live`; the most pixels of a frame."""

    image: Path
    options: dict[str, Any]
    frame_pixels: int


class LiveProcess(Protocol):
    """A process at work."""

    def send(self, kind: bytes, data: bytes) -> bool:
        """Give it a message; False where it has not taken the last ones yet, and this one is dropped."""

    async def receive(self) -> tuple[bytes, bytes] | None:
        """Its next message; None once it has ended."""

    def kill(self) -> None:
        """End it now; again is no error."""


StartLive = Callable[[LiveOrder], Awaitable[LiveProcess]]
"""Starts a process. Raises OSError."""
