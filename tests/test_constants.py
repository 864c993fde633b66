"""A constant's name has one meaning: nobody who meets it in two files wonders which of them it is."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parent.parent
PACKAGES = ("engine", "service", "worker", "shell")
SAME_IN_EACH = frozenset({"KIND", "STAGES", "MODEL_FILE", "MODEL_SHA256"})
"""What each kind of jobs says of itself, and each model that is carried along."""


def constants(source: str) -> Iterator[str]:
    """The public constants that a module makes, once for each time that it does; names of types are none."""
    for node in ast.parse(source).body:
        match node:
            case ast.Assign(targets=targets, value=value):
                made = targets
            case ast.AnnAssign(target=target, value=value):
                made = [target]
            case _:
                continue
        if isinstance(value, ast.Call) and ast.unparse(value.func).endswith(("TypeVar", "ParamSpec")):
            continue
        for target in made:
            for one in target.elts if isinstance(target, ast.Tuple) else [target]:
                if isinstance(one, ast.Name) and one.id.isupper() and not one.id.startswith("_"):
                    yield one.id


def test_one_name_has_one_meaning() -> None:
    places: dict[str, list[str]] = defaultdict(list)
    for package in PACKAGES:
        for path in sorted((ROOT / package).rglob("*.py")):
            if "migrations" not in path.parts:
                for name in constants(path.read_text()):
                    places[name].append(str(path.relative_to(ROOT)))
    assert len(places) > 2000
    assert {name: where for name, where in places.items() if len(where) > 1 and name not in SAME_IN_EACH} == {}


def test_constants_are_told_from_other_names() -> None:
    source = "A_B, C = 1, 2\nD: int = 3\nT = TypeVar('T')\n_E = 4\nf = 5\nD = 6\n"
    assert list(constants(source)) == ["A_B", "C", "D", "D"]
