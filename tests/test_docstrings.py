"""Docstrings are short sentences, and none leans on the one before it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parent.parent
PACKAGES = ("engine", "service", "worker", "shell", "galatea", "galatea_client", "benchmarks", "scripts")
MAX_SENTENCE_WORDS = 50

SENTENCE_END = re.compile(r"(?<=[.!?:])\s+(?=[A-Z`\"(\d\[])")
NEW_PARAGRAPH = re.compile(r"\n\s*\n|\n\s*(?=[a-z_, ]+ : )|\n\s*[-*|] |\n\s*-{4,}\n")
LEANING = re.compile(r"(The same\b|And\b|Likewise\b|Its own\b|Theirs\b)")
"""How a docstring begins that cannot be read without another."""


def docstrings(source: str) -> Iterator[str]:
    """All of a file: of the module, of classes and functions, of constants and fields."""
    for node in ast.walk(ast.parse(source)):
        for one in getattr(node, "body", None) or () if not isinstance(node, ast.Lambda | ast.IfExp) else ():
            match one:
                case ast.Expr(value=ast.Constant(value=str(text))):
                    yield text.strip()


def sentences(text: str) -> Iterator[str]:
    for paragraph in NEW_PARAGRAPH.split(text):
        if not paragraph.lstrip().startswith("|"):  # a table
            yield from SENTENCE_END.split(" ".join(paragraph.split()))


def words(sentence: str) -> int:
    return len(re.findall(r"[\w`'./%-]+", sentence))


def told() -> Iterator[tuple[str, str]]:
    for package in PACKAGES:
        for path in sorted((ROOT / package).rglob("*.py")):
            for text in docstrings(path.read_text()):
                yield str(path.relative_to(ROOT)), text


def test_no_docstring_leans_on_the_one_before_it() -> None:
    assert [(place, text[:60]) for place, text in told() if LEANING.match(text)] == []


def test_no_sentence_is_longer_than_anybody_follows() -> None:
    found = [(place, one) for place, text in told() for one in sentences(text)]
    assert len(found) > 10_000
    assert [(place, one[:80]) for place, one in found if words(one) > MAX_SENTENCE_WORDS] == []


def test_what_is_told_where_is_found() -> None:
    source = (
        '"""A. B c."""\nD = 1\n"""The same of d."""\ndef f():\n    """One\n\n    x : a y\n    """\n    return "no"\n'
    )
    found = list(docstrings(source))
    assert found == ["A. B c.", "The same of d.", "One\n\n    x : a y"]
    assert list(sentences(found[0])) == ["A.", "B c."] and list(sentences(found[2])) == ["One", "x : a y"]
