"""MediaPipe's solutions, without what they never need."""

from __future__ import annotations

import importlib
import sys
from types import ModuleType
from typing import Any

from google.protobuf import message_factory


def solution(name: str) -> ModuleType:
    """The module `mediapipe.python.solutions.NAME`.

    MediaPipe imports matplotlib for drawings that nobody here asks for, most of a second in every process: its
    place is held while MediaPipe is imported, and it is loaded when somebody does draw.
    """
    full = f"mediapipe.python.solutions.{name}"
    _know_old_ways()
    if "mediapipe" in sys.modules or "matplotlib" in sys.modules:
        return importlib.import_module(full)
    held = _Later("matplotlib"), _Later("matplotlib.pyplot")
    held[0].pyplot = held[1]  # type: ignore[attr-defined]
    for place in held:
        sys.modules[place.__name__] = place
    try:
        return importlib.import_module(full)
    finally:
        for place in held:
            del sys.modules[place.__name__]


def _know_old_ways() -> None:
    """Give Protocol Buffers back the method by which MediaPipe's native part looks up messages (gone since release 5):
    without it each process prints an error, and goes on."""
    factory: Any = message_factory.MessageFactory
    if not hasattr(factory, "GetPrototype"):
        factory.GetPrototype = lambda self, descriptor: message_factory.GetMessageClass(descriptor)


class _Later(ModuleType):
    """Stands for a module that is imported when something of it is used."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(importlib.import_module(self.__name__), name)
