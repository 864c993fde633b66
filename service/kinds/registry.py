"""The job kinds on offer: the engine's own and those that an operator adds (`GALATEA_EXTRA_KINDS`)."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence

from engine.kind import Kind


def load_kinds(extra: Sequence[str] = ()) -> Mapping[str, Kind]:
    """Kinds by name. `extra` are places of further ones, `module:attribute`."""
    from engine.kinds import KINDS

    kinds = dict(KINDS)
    for place in extra:
        module, _, attribute = place.partition(":")
        kind = getattr(importlib.import_module(module), attribute or "KIND")
        if not isinstance(kind, Kind):
            raise TypeError(f"GALATEA_EXTRA_KINDS: {place} is not an engine.kind.Kind")
        kinds[kind.name] = kind
    return kinds
