"""The job kinds on offer: the engine's own, unless an operator chooses others or adds to them (`GALATEA_KINDS`)."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence

from engine.kind import Kind


def load_kinds(places: Sequence[str]) -> Mapping[str, Kind]:
    """Kinds by name, from places `module:attribute` that hold a `Kind` or a mapping of them."""
    kinds: dict[str, Kind] = {}
    for place in places:
        module, _, attribute = place.partition(":")
        found = getattr(importlib.import_module(module), attribute or "KINDS")
        for kind in [found] if isinstance(found, Kind) else list(found.values()):
            if not isinstance(kind, Kind):
                raise TypeError(f"GALATEA_KINDS: {place} holds something that is no engine.kind.Kind")
            kinds[kind.name] = kind
    return kinds


def require_known(names: Sequence[str], kinds: Mapping[str, Kind]) -> None:
    """Raise ValueError where a worker is to serve a kind (`GALATEA_WORKER_KINDS`) that there is not."""
    if unknown := sorted(set(names) - set(kinds)):
        raise ValueError(f"GALATEA_WORKER_KINDS: there is no job kind {unknown[0]}; there are {', '.join(kinds)}.")
