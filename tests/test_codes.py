"""Every code by which an error or a warning is known stands in the documents, and what ends a job on the page too."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
from fnmatch import fnmatchcase
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parent.parent
ENDINGS = {"InputError", "FetchFailed", "failed", "fail"}
"""What ends a job with a code, beside a `{"code": ...}`."""


def sources(*folders: str) -> list[ast.Module]:
    return [tree for folder in folders for tree in parsed(folder)]


@cache
def parsed(folder: str) -> list[ast.Module]:
    return [ast.parse(path.read_text()) for path in sorted((ROOT / folder).rglob("*.py"))]


@cache
def nodes(tree: ast.Module) -> list[ast.AST]:
    return list(ast.walk(tree))


def parameters(tree: ast.Module) -> Iterator[tuple[str, list[str]]]:
    """Functions, methods and classes: name, and the names of what they are called with."""
    for node in nodes(tree):
        for one in getattr(node, "body", []) if isinstance(node, ast.Module | ast.ClassDef) else []:
            if isinstance(one, ast.FunctionDef):
                name = node.name if one.name == "__init__" and isinstance(node, ast.ClassDef) else one.name
                yield name, [argument.arg for argument in one.args.args if argument.arg != "self"]
        if isinstance(node, ast.ClassDef) and node.decorator_list:
            yield node.name, [one.target.id for one in node.body if isinstance(one, ast.AnnAssign)]  # type: ignore[union-attr]


def spelled(value: ast.expr) -> set[str]:
    """The codes that an expression spells out, with a `*` for what it fills in."""
    match value:
        case ast.Constant(value=str(text)):
            found = {text}
        case ast.JoinedStr(values=parts):
            found = {"".join(str(part.value) if isinstance(part, ast.Constant) else "*" for part in parts)}
        case ast.IfExp(body=one, orelse=other):
            found = spelled(one) | spelled(other)
        case ast.Tuple(elts=[first, *_]):
            found = spelled(first)
        case _:
            found = set()
    return {code for code in found if re.fullmatch(r"[a-z0-9_*]*[a-z][a-z0-9_*]*", code)}


def codes(trees: list[ast.Module], by: Iterable[str] | None = None) -> set[str]:
    """All that is given to a parameter, a key or a variable of the name `code`; with `by`, to these callables only, and
    to a key. A callable that is handed on keeps its name, but for an underscore."""
    everywhere = defaultdict(set)
    for name, arguments in (found for tree in trees for found in parameters(tree)):
        if "code" in arguments:
            everywhere[name].add(arguments.index("code"))
    for node in (node for tree in trees for node in nodes(tree)):
        match node:  # a class that is made as the one that it is of
            case ast.ClassDef(name=name, bases=[ast.Name(id=base)]) if base in everywhere and name not in everywhere:
                everywhere[name] = everywhere[base]
    places = {name: found for name, found in everywhere.items() if by is None or name in by}
    found: set[str] = set()
    for node in (node for tree in trees for node in nodes(tree)):
        match node:
            case ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name), args=given, keywords=named):
                if name in places or (name := name.removeprefix("_")) in places:
                    values = [given[place] for place in places[name] if place < len(given)]
                    values += [one.value for one in named if one.arg == "code"]
                    found.update(*map(spelled, values))
            case ast.Dict(keys=keys, values=values):
                pairs = zip(keys, values, strict=True)
                found.update(*(spelled(value) for key, value in pairs if key and ast.unparse(key) == "'code'"))
            case ast.Assign(targets=[ast.Name(id="code") | ast.Tuple(elts=[ast.Name(id="code"), *_])], value=value):
                found |= spelled(value) if by is None else set()
    return found


def test_codes_are_found_where_they_are_given() -> None:
    program = """
class Refused(Exception):
    def __init__(self, status: int, code: str): ...

class Run:
    def warn(self, code: str, message: str): ...

@dataclass
class Outcome:
    seconds: float
    code: str

def work(warn, noun, few):
    warn("handed_on", "A sentence.")
    self._warn("met" if few else "missed", "No code: 'spoken_of'.")
    code, detail = "taken_apart", "A sentence."
    Outcome(1.0, "dated"), {"code": "keyed"}, Refused(404, code="named")
    raise Refused(422, f"{noun}_lost")
"""
    warned = {"handed_on", "met", "missed"}
    assert codes([ast.parse(program)]) == warned | {"taken_apart", "dated", "keyed", "named", "*_lost"}
    assert codes([ast.parse(program)], by=["Refused"]) == {"named", "*_lost", "keyed"}


def test_every_code_is_documented() -> None:
    found = codes(sources("engine", "galatea", "service", "worker"))
    assert len(found) > 150 and {"no_face", "target_not_neutral", "time_limit", "redirect", "*_built_in"} <= found
    documents = "".join(page.read_text() for page in (ROOT / "docs").rglob("*.md"))
    documented = set(re.findall(r"`([a-z0-9_]+)`", documents))
    assert sorted(code for code in found if not any(fnmatchcase(known, code) for known in documented)) == []


def test_the_page_has_words_for_all_that_ends_a_job() -> None:
    found = codes(sources("engine", "worker", "service"), by=ENDINGS) - {"gl_unavailable"}  # of no job
    assert {"no_face", "disk_full", "attempts_exhausted", "*_size"} <= found
    pages = [ROOT / "web/src/language/words/en/failures.ts", *(ROOT / "web/src/kinds").glob("*/words/en.ts")]
    assert len(pages) > 2
    worded = {
        code
        for page in pages
        for block in re.findall(r"(?ms)^  failures: \{$(.*?)^  \}", page.read_text())
        for code in re.findall(r"(?m)^    (\w+): '", block)
    }
    assert sorted(code for code in found if not any(fnmatchcase(known, code) for known in worded)) == []
