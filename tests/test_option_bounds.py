"""What strangers may give as options of a job is bounded: each number, each list, each object and each text."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from pydantic import ValidationError

from engine.character.options import MAX_STROKE_POINTS, CharacterOptions
from engine.kinds import KINDS
from engine.portrait.options import PortraitOptions

BOUNDS = {
    "integer": ("minimum", "maximum"),
    "number": ("minimum", "maximum"),
    "array": ("maxItems",),
    "object": ("maxProperties",),
    "string": ("maxLength",),
}


def unbounded(schema: dict[str, Any], path: str = "") -> Iterator[str]:
    """The places in a JSON schema at which something may be of any size."""
    if "properties" not in schema and "enum" not in schema and "const" not in schema:
        bounds = BOUNDS.get(schema.get("type", ""), ())
        if not all(bound in schema or f"exclusiveM{bound[1:]}" in schema for bound in bounds):
            yield path
    for key in ("properties", "$defs"):
        for name, below in schema.get(key, {}).items():
            yield from unbounded(below, f"{path}/{name}")
    for key in ("anyOf", "prefixItems"):
        for below in schema.get(key, ()):
            yield from unbounded(below, path)
    for key in ("items", "additionalProperties", "propertyNames"):
        if isinstance(below := schema.get(key), dict):
            yield from unbounded(below, f"{path}/{key}")


def test_a_schema_without_bounds_is_found() -> None:
    schema = {"properties": {"a": {"type": "integer", "minimum": 0}, "b": {"anyOf": [{"type": "string"}]}}}
    assert list(unbounded(schema)) == ["/a", "/b"]


@pytest.mark.parametrize("name", sorted(KINDS))
def test_every_option_of_every_kind_has_bounds(name: str) -> None:
    assert list(unbounded(KINDS[name].options.model_json_schema())) == []


@pytest.mark.parametrize("option", ["face_index", "driver_face_index", "neutral_frame"])
def test_numbers_beyond_all_meaning_are_refused(option: str) -> None:
    with pytest.raises(ValidationError):
        PortraitOptions.model_validate({option: 2**70})


@pytest.mark.parametrize(
    ("options", "given"),
    [
        (PortraitOptions, {"landmarks": ["x"] * 5000}),
        (PortraitOptions, {"reactive": [3] * 5000}),
        (PortraitOptions, {"follow": ["x"] * 5000}),
        (CharacterOptions, {"keep": ["x"] * 5000}),
        (CharacterOptions, {"mask_strokes": ["x"] * 500}),
        (CharacterOptions, {"label_strokes": [{"path": ["x"] * 5000, "radius": 1, "part": "head"}] * 50}),
    ],
)
def test_of_a_list_no_more_than_the_first_fault_is_looked_at(options: Any, given: dict[str, object]) -> None:
    with pytest.raises(ValidationError) as caught:
        options.model_validate(given)
    assert caught.value.error_count() <= 4


def test_strokes_have_so_many_points_together() -> None:
    def drawn(points: int) -> CharacterOptions:
        strokes = [{"path": [(1, 1)] * 5000, "radius": 1, "person": True}] * (points // 5000)
        return CharacterOptions.model_validate({"mask_strokes": strokes})

    assert len(drawn(MAX_STROKE_POINTS).mask_strokes) == 10
    with pytest.raises(ValidationError, match="points together"):
        drawn(MAX_STROKE_POINTS + 5000)
