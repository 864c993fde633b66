"""Who reads a dataclass of many arrays reads of each what it holds."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ENGINE = Path(__file__).parent.parent / "engine"
MIN_ARRAYS = 4
"""Array fields from which on each has a line of its own."""

ARRAY = re.compile(r"\b(NDArray|ndarray|cs[rc]_array|Array|Mask)\b")
"""What the annotation of an array holds: NumPy's own, SciPy's, or an alias of them in the same file."""

SAMPLE = '''
@dataclass
class Told:
    """Arrays.

    one : (N,) a first.
    two, three : (N,) more.
    """

    one: NDArray[np.float32]
    two: NDArray[np.float32]
    three: NDArray[np.float32] | None
    four: np.ndarray
    """(N,) a fourth."""
    five: csr_array
    six: tuple[Array, Array] = ()
    seven: int = 0
'''


def is_record(node: ast.ClassDef) -> bool:
    """Whether a class is a dataclass or a named tuple."""
    made_by = [ast.unparse(one) for one in node.decorator_list]
    return any("dataclass" in one for one in made_by) or "NamedTuple" in [ast.unparse(one) for one in node.bases]


def array_fields(node: ast.ClassDef) -> dict[str, bool]:
    """The array fields of a class, and whether each has a line of its docstring or a docstring of its own."""
    lines = (ast.get_docstring(node) or "").splitlines()
    named = {name for line in lines if " : " in line for name in re.split(r", *", line.split(" : ")[0].strip())}
    fields = {}
    for one, following in zip(node.body, [*node.body[1:], None], strict=True):
        match one:
            case ast.AnnAssign(target=ast.Name(id=name)) if ARRAY.search(ast.unparse(one.annotation)):
                own = isinstance(following, ast.Expr) and isinstance(following.value, ast.Constant)
                fields[name] = own or name in named
    return fields


def records() -> Iterator[tuple[str, ast.ClassDef]]:
    """The dataclasses and named tuples of the engine and where they are."""
    for path in sorted(ENGINE.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ClassDef) and is_record(node):
                yield f"{path.relative_to(ENGINE.parent)}: {node.name}", node


def test_each_of_many_arrays_has_a_line() -> None:
    many = {place: fields for place, node in records() if len(fields := array_fields(node)) >= MIN_ARRAYS}
    assert len(many) > 10
    assert [f"{place}.{name}" for place, fields in many.items() for name, told in fields.items() if not told] == []


def test_a_field_that_is_left_out_is_found() -> None:
    (node,) = ast.parse(SAMPLE).body
    assert isinstance(node, ast.ClassDef) and is_record(node)
    assert array_fields(node) == {"one": True, "two": True, "three": True, "four": True, "five": False, "six": False}
