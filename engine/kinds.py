"""The job kinds that the engine offers, by name: adding a system is adding its folder and one line here."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from engine import avatar, character, motion_file, persona, portrait
from engine.kind import Kind
from engine.portrait import driver_segments

KINDS: Mapping[str, Kind] = MappingProxyType(
    {
        kind.name: kind
        for kind in (
            *(portrait.KIND, driver_segments.KIND, character.KIND, avatar.KIND),
            *(persona.KIND, motion_file.KIND),
        )
    }
)
