"""MediaPipe's solutions, without what they never need."""

from __future__ import annotations

import importlib
import sys
from threading import Lock
from types import ModuleType
from typing import Any

from google.protobuf import message_factory

UNNEEDED_MODULES = (
    *("matplotlib", "matplotlib.pyplot", "mediapipe.tasks", "mediapipe.tasks.python"),
    *("mediapipe.python.solutions.objectron", "mediapipe.python.solutions.download_utils"),
)
"""What MediaPipe imports for others alone."""

_ONE_AT_A_TIME = Lock()
"""MediaPipe's modules import each other in circles: threads that begin at once would find them half made."""


def load_solution(name: str) -> ModuleType:
    """The module `mediapipe.python.solutions.NAME`.

    MediaPipe imports matplotlib for drawings that nobody here asks for, most of a second in every process, and more of its
    own: their places are held while MediaPipe is imported, and they are loaded when somebody does use them.
    """
    with _ONE_AT_A_TIME:
        return _imported(f"mediapipe.python.solutions.{name}")


def _imported(full: str) -> ModuleType:
    restore_message_lookup()
    if "mediapipe" in sys.modules:
        return importlib.import_module(full)
    held = [_Later(name) for name in UNNEEDED_MODULES if name not in sys.modules]
    for place in held:
        sys.modules[place.__name__] = place
        _attach(place)
    try:
        return importlib.import_module(full)
    finally:
        for place in held:
            _attach(place)
            del sys.modules[place.__name__]


def _attach(module: ModuleType) -> None:
    """Make it an attribute of the package it is in, as importing it does."""
    package, _, name = module.__name__.rpartition(".")
    if package in sys.modules:
        vars(sys.modules[package]).setdefault(name, module)


def restore_message_lookup() -> None:
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
