"""MediaPipe's solutions, without what they never need."""

from __future__ import annotations

import importlib
import os
import sys
from collections import defaultdict
from collections.abc import Hashable, Iterator
from contextlib import contextmanager
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

_IDLE: defaultdict[Hashable, list[Any]] = defaultdict(list)
"""Networks that nobody uses at the moment, by what they are; only while somebody keeps them."""
_KEEPERS: list[object] = []
_LENDING = Lock()


@contextmanager
def kept_networks() -> Iterator[None]:
    """As long as the block lasts, what `network` lent is kept and lent again: loading one takes three times as long as what
    it does with a picture. All that are kept at once take about 300 MB: for whoever looks at many pictures one after another."""
    keeper = object()
    with _LENDING:
        _KEEPERS.append(keeper)
    try:
        yield
    finally:
        with _LENDING:
            _KEEPERS.remove(keeper)
            ended = [] if _KEEPERS else [one for idle in _IDLE.values() for one in idle]
            if not _KEEPERS:
                _IDLE.clear()
        for one in ended:
            one.close()


@contextmanager
def network(solution: str, kind: str, follows: bool = False, **settings: Any) -> Iterator[Any]:
    """The class `kind` of `mediapipe.python.solutions.SOLUTION` with these settings, for the block: one that nobody uses and
    somebody keeps (`kept_networks`), or a new one. It knows of no picture yet; `follows`: it would remember those that it saw."""
    key = (solution, kind, *sorted(settings.items()))
    with _LENDING:
        lent = _IDLE[key].pop() if _IDLE[key] else None
    if lent is None:
        lent = getattr(load_solution(solution), kind)(**settings)
    elif follows:
        lent.reset()
    kept = False
    try:
        yield lent
        with _LENDING:
            if kept := bool(_KEEPERS):
                _IDLE[key].append(lent)
    finally:
        if not kept:
            lent.close()


os.register_at_fork(after_in_child=_IDLE.clear)  # their threads are not in the new process


def load_solution(name: str) -> ModuleType:
    """The module `mediapipe.python.solutions.NAME`.

    MediaPipe imports matplotlib for drawings that nobody here asks for, most of a second in every process, and more of
    its own. Their places are held while MediaPipe is imported, and they are loaded when somebody does use them.
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
