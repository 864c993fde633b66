"""The stages of a job in the order of its pipeline, whichever attempt came across them."""

from __future__ import annotations

from collections.abc import Iterable

MAX_STAGE_NAMES = 100
"""Names that are kept: a pipeline has fewer."""


class Stages:
    """The names of the stages that have begun. An attempt passes quickly through what an earlier one has stored, and may
    tell of a stage that was not told of then: it takes its place behind the one that it follows."""

    def __init__(self, names: Iterable[str] = ()):
        self.names = list(names)
        self._place = 0
        self._told = len(self.names)

    def begin(self, name: str) -> None:
        """This stage begins, or goes on."""
        if name not in self.names and len(self.names) < MAX_STAGE_NAMES:
            self.names.insert(self._place, name)
        if name in self.names:
            self._place = max(self._place, self.names.index(name) + 1)

    def news(self) -> bool:
        """Whether there are more than when this was asked last."""
        told, self._told = self._told, len(self.names)
        return self._told > told
