"""Every run is used as a context manager, so that it is over, and nothing beside goes on, however it is left."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parent.parent
FOLDERS = ("engine", "galatea", "service", "worker", "shell", "benchmarks", "scripts", "tests")
ABOUT_RUNS = ROOT / "tests" / "test_run.py"
"""Tests of what a run does by itself."""


def left_open(tree: ast.Module) -> Iterator[int]:
    """The lines on which a `Run` is made that no `with` statement leaves."""
    items = [item for node in ast.walk(tree) if isinstance(node, ast.With | ast.AsyncWith) for item in node.items]
    left = {id(item.context_expr) for item in items}
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and id(node) not in left and ast.unparse(node.func).split(".")[-1] == "Run":
            yield node.lineno


def test_each_run_is_made_by_a_with_statement() -> None:
    paths = [path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*.py")) if path != ABOUT_RUNS]
    texts = {path: text for path in paths if "Run(" in (text := path.read_text())}  # no other makes one
    found = [f"{path.relative_to(ROOT)}:{line}" for path, text in texts.items() for line in left_open(ast.parse(text))]
    assert len(texts) > 10
    assert found == []


def test_a_run_that_nothing_leaves_is_found() -> None:
    program = "with Run() as run:\n    work(run)\nother = Run(store=kept)\nwork(run=engine.run.Run())\n"
    assert list(left_open(ast.parse(program))) == [3, 4]
