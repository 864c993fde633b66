"""The rooms of the house and who imports whom: `python -m scripts.import_graph` prints a table, and with `--arrows` each
arrow.

A room is what lies directly in a package: a folder, or a file beside the folders. An arrow says that one room imports
another. Rooms that can be reached from each other form a circle. An arrow points up where the layers of `.importlinter`,
or of `web/layers.ini` for the page, do not allow it.
"""

from __future__ import annotations

import argparse
import ast
import re
from collections.abc import Iterable, Iterator, Mapping
from configparser import ConfigParser
from dataclasses import dataclass
from pathlib import Path
from statistics import median

PACKAGES = ("engine", "service", "worker", "shell", "benchmarks")
PAGE_FOLDER = Path("web", "src")
RULES_FILES = (".importlinter", "web/layers.ini")
"""Where the layers are written; the second is in the form of the first."""

GENERATED_HEADER = re.compile("not to be edited")
"""How a file begins that nobody has written."""

PAGE_IMPORT = re.compile(r"""(\bfrom\s+|\bimport\s*\(?)\s*["'](\.[^"']*)["']""")
PAGE_FUNCTION = re.compile(r"(?:export )?(?:default )?(?:async )?(?:function\b|const \w+ = .*(?:=>|\() ?\{?$)")

Arrows = Mapping[tuple[str, str], int]
"""From room to room: how many files import."""


@dataclass(frozen=True)
class File:
    """A file of source code."""

    name: str
    """Below its package, without ending: `jobs/service`."""
    imports: frozenset[str]
    """The files of the same package that it imports, by their names."""
    fetched: frozenset[str]
    """Which of `imports` are fetched only when they are needed: `import(...)` in the page."""
    lines: int
    functions: tuple[int, ...]
    """The lines of each function and method."""

    @property
    def room(self) -> str:
        return self.name.split("/")[0]


def python_files(root: Path, package: str) -> list[File]:
    """The files of a Python package, its own `__init__.py` apart."""
    paths = {_below(path, root / package): path for path in sorted((root / package).rglob("*.py"))}
    paths.pop("", None)
    files = []
    for name, path in paths.items():
        tree = ast.parse(path.read_text())
        aims = {aim for target in _imported(tree, package) if (aim := _known(target, paths)) not in (None, name)}
        functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)]
        lengths = tuple((node.end_lineno or node.lineno) - node.lineno + 1 for node in functions)
        lines = len(path.read_text().splitlines())
        files.append(File(name, frozenset(filter(None, aims)), frozenset(), lines, lengths))
    return files


def page_files(folder: Path) -> list[File]:
    """The files of the page, by its import lines; functions are those that begin at the margin."""
    paths = {path.relative_to(folder).with_suffix("").as_posix(): path for path in sorted(folder.rglob("*.ts*"))}
    files = []
    for name, path in paths.items():
        text = path.read_text()
        if GENERATED_HEADER.search(text[:200]):
            continue
        loaded, fetched = set[str](), set[str]()
        for how, given in PAGE_IMPORT.findall(text):
            aim = (path.parent / given).resolve()
            if aim.is_relative_to(folder.resolve()):
                below = aim.relative_to(folder.resolve()).as_posix().removeprefix(".")
                aims = {re.sub(r"\.(js|tsx?)$", "", below), f"{below}/index".lstrip("/")} & paths.keys() - {name}
                (fetched if how.endswith("(") else loaded).update(aims)
        lines = text.splitlines()
        imports, later = frozenset(loaded | fetched), frozenset(fetched - loaded)
        files.append(File(name, imports, later, len(lines), tuple(_page_functions(lines))))
    return files


def arrows(files: Iterable[File]) -> dict[tuple[str, str], int]:
    """From which room to which other one files import, and how many do."""
    found: dict[tuple[str, str], int] = {}
    for file in files:
        for room in {aim.split("/")[0] for aim in file.imports} - {file.room}:
            found[file.room, room] = found.get((file.room, room), 0) + 1
    return found


def loads(files: Iterable[File]) -> dict[tuple[str, str], int]:
    """From file to file: what comes with it and whose types it takes, not what it fetches later."""
    return {(file.name, other): 1 for file in files for other in file.imports - file.fetched}


def circles(found: Arrows) -> list[list[str]]:
    """Groups of rooms of which each can be reached from every other."""
    ends: dict[str, list[str]] = {}
    for start, end in found:
        ends.setdefault(start, []).append(end)
    reached: dict[str, set[str]] = {}
    for room in {room for arrow in found for room in arrow}:
        waiting, seen = [room], set[str]()
        while waiting:
            for end in set(ends.get(waiting.pop(), ())) - seen:
                seen.add(end)
                waiting.append(end)
        reached[room] = seen
    groups = {frozenset(other for other in seen if room in reached[other]) for room, seen in reached.items()}
    return sorted(sorted(group) for group in groups if group)


def layers(root: Path, package: str) -> list[tuple[frozenset[str], bool]]:
    """The layers of a package, or of the `page`, as the rules have them, the highest first; and whether the rooms of each may import
    each other. Empty where it has none."""
    rules = ConfigParser()
    rules.read(root / name for name in RULES_FILES)
    for name in rules.sections():
        if rules.get(name, "type", fallback="") == "layers" and rules.get(name, "containers", fallback="") == package:
            written = rules.get(name, "layers").strip().splitlines()
            return [(frozenset(re.findall(r"\w+", line)), "|" not in line) for line in written]
    return []


def upward(found: Arrows, order: list[tuple[frozenset[str], bool]]) -> list[tuple[str, str]]:
    """The arrows that point to a higher layer, or to a room of the same one where that is not allowed."""
    height = {room: -number for number, (rooms, _) in enumerate(order) for room in rooms}
    level = {room for rooms, free in order if not free for room in rooms}
    return sorted(
        (start, end)
        for start, end in found
        if start in height and end in height and height[end] >= height[start] + (end not in level)
    )


def row(name: str, files: list[File], order: list[tuple[frozenset[str], bool]]) -> str:
    """A row of the table."""
    found = arrows(files)
    rings = circles(found)
    functions = [length for file in files for length in file.functions] or [0]
    lengths = [file.lines for file in files]
    numbers = [
        len(files),
        len({file.room for file in files}),
        len(found),
        f"{len(rings)} (of {sum(map(len, rings))} rooms)" if rings else 0,
        len(upward(found, order)) if order else "no layers",
        f"{median(lengths):g}",
        max(lengths),
        f"{median(functions):g}",
        max(functions),
    ]
    return "| " + " | ".join(map(str, [name, *numbers])) + " |"


TABLE_HEAD = """\
| | files | rooms | imports between rooms | circles | arrows up | file, median | longest | function, median | longest |
| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"""


def _below(path: Path, folder: Path) -> str:
    name = path.relative_to(folder).with_suffix("").as_posix()
    return "" if name == "__init__" else name.removesuffix("/__init__")


def _imported(tree: ast.AST, package: str) -> Iterator[str]:
    """What a file imports of its own package, below it: modules, and names in modules."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        else:
            continue
        yield from (name.removeprefix(f"{package}.") for name in names if name.startswith(f"{package}."))


def _known(target: str, paths: Mapping[str, Path]) -> str | None:
    """The file that an imported name lies in."""
    while target:
        if target.replace(".", "/") in paths:
            return target.replace(".", "/")
        target = target.rpartition(".")[0]
    return None


def _page_functions(lines: list[str]) -> Iterator[int]:
    start: int | None = None
    for number, line in enumerate(lines):
        if PAGE_FUNCTION.match(line):
            start = number
        if start is not None and (line.startswith("}") or re.match(r"\).*[;}]$", line)):
            yield number - start + 1
            start = None


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--arrows", action="store_true", help="print each arrow, too")
    parser.add_argument("--root", type=Path, default=Path(), help="the checkout")
    given = parser.parse_args()
    houses = {package: python_files(given.root, package) for package in PACKAGES}
    houses["page"] = page_files(given.root / PAGE_FOLDER)
    print(TABLE_HEAD)
    for name, files in houses.items():
        print(row(name, files, layers(given.root, name)))
    for name, files in houses.items() if given.arrows else ():
        found = arrows(files)
        up = set(upward(found, layers(given.root, name)))
        print(f"\n{name}")
        for (start, end), count in sorted(found.items()):
            print(f"  {start} -> {end} ({count}){'  up' if (start, end) in up else ''}")
        for ring in circles(found):
            print(f"  circle: {', '.join(ring)}")


if __name__ == "__main__":
    main()
