"""What MediaPipe and TensorFlow Lite print to standard error, left out while everything else goes through.

Their native code writes to file descriptor 2, and neither an environment variable nor a function of theirs stops it. So
the descriptor leads through a pipe meanwhile: lines that are theirs end there; what other threads and libraries write is
passed on as it comes. A process that was started meanwhile has inherited the pipe: for it, that goes on as long as it lives.
"""

from __future__ import annotations

import os
import re
import selectors
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress

STANDARD_ERROR = 2
LIBRARY_LINE = re.compile(
    rb"[IWE]\d{4} [\d:. ]+ +\d+ \S+\.(?:cc|cpp|h):\d+\] |(?:INFO: )?Created TensorFlow Lite |WARNING: All log mess"
)
LIBRARY_LINE_BEGINNING = re.compile(
    rb"(?:[IWE]\d{0,4}|[IWE]\d{4} .*|INFO: Cre.*|WARNING: All.*|I|IN|INF|INFO:?|INFO: (?:C|Cr)?|W|WA|WAR)$"
)
"""A line's beginning that may yet turn out to be theirs."""
READ_PIECE_BYTES = 1 << 16


class _Sieve:
    """The way from descriptor 2 to where it led, as long as somebody wants it."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._users = 0
        self._real = -1
        self._wake = -1
        self._passed: threading.Event | None = None

    def enter(self) -> None:
        with self._lock:
            self._users += 1
            if self._users > 1:
                return
            try:
                self._real = os.dup(STANDARD_ERROR)
            except OSError:  # it is closed: nobody reads anything
                return
            _flush()
            source, sink = os.pipe()
            wake, self._wake = os.pipe()
            os.dup2(sink, STANDARD_ERROR)
            os.close(sink)
            os.set_blocking(source, False)
            self._passed = threading.Event()
            way = (source, os.dup(self._real), wake, self._passed)
            threading.Thread(target=_pass_on, args=way, daemon=True).start()

    def leave(self) -> None:
        with self._lock:
            self._users -= 1
            if self._users or self._passed is None:
                return
            _flush()
            os.dup2(self._real, STANDARD_ERROR)
            os.close(self._real)
            os.close(self._wake)
            self._passed.wait()
            self._passed = None


_SIEVE = _Sieve()
"""The process has one standard error, whoever asks."""


@contextmanager
def silence_libraries() -> Iterator[None]:
    """Within, native libraries are not heard; calls at once from several threads share it."""
    _SIEVE.enter()
    try:
        yield
    finally:
        _SIEVE.leave()


def _flush() -> None:
    with suppress(AttributeError, OSError, ValueError):  # none, or none that can be written
        sys.stderr.flush()


def _pass_on(source: int, target: int, wake: int, passed: threading.Event) -> None:
    """Pass on what comes until nobody is left who could write. Once the other end of `asked` is closed, all that has come by
    then is passed on, and `passed` is set."""
    rest, ending = b"", False
    try:
        with selectors.DefaultSelector() as selector:
            for descriptor in (source, wake):
                selector.register(descriptor, selectors.EVENT_READ)
            while True:
                ready = {key.fd for key, _ in selector.select(0 if ending else None)}
                text = os.read(source, READ_PIECE_BYTES) if source in ready else b""
                rest = sift(rest + text, target)
                if source in ready and not text:
                    break
                if ending and not text:
                    rest, ending = _told(rest, target), False
                    passed.set()
                if wake in ready:
                    selector.unregister(wake)
                    ending = True
        _told(rest, target)
    finally:
        passed.set()
        for descriptor in (source, target, wake):
            os.close(descriptor)


def _told(rest: bytes, target: int) -> bytes:
    """Pass on what was held back, unless it is a line of theirs; nothing is then."""
    if not LIBRARY_LINE.match(rest):
        _write(target, rest)
    return b""


def sift(text: bytes, target: int) -> bytes:
    """Pass on all but their lines; returns the beginning of a line of which that cannot be told yet."""
    *lines, rest = text.split(b"\n")
    kept = b"".join(line + b"\n" for line in lines if not LIBRARY_LINE.match(line))
    held = LIBRARY_LINE_BEGINNING.match(rest)
    _write(target, kept if held else kept + rest)
    return rest if held else b""


def _write(target: int, text: bytes) -> None:
    with suppress(OSError):
        while text:
            text = text[os.write(target, text) :]
