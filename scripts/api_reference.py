"""A hook of mkdocs: the pages under `reference/`, one for each group of operations, drawn from the OpenAPI document."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

sys.path.insert(0, str(Path(__file__).parent.parent))  # mkdocs runs hooks from their file alone

from scripts.openapi import document as openapi

OPENAPI_METHODS = ("get", "head", "options", "post", "put", "patch", "delete")
Document = Mapping[str, Any]


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Put the pages into the table of contents."""
    pages = reference(openapi())
    section = next(one for one in config.nav or [] if "API reference" in one)
    section["API reference"] = [{_title(text): name} for name, text in pages.items()]
    config.extra["reference"] = pages
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages."""
    for name, text in config.extra.pop("reference").items():
        files.append(File.generated(config, name, content=text))
    return files


def reference(document: Document) -> dict[str, str]:
    """Every page by its name, in Markdown."""
    tags: dict[str, list[str]] = {}
    for path, item in document["paths"].items():
        for method in OPENAPI_METHODS:
            if method in item:
                operation = item[method]
                tag = operation.get("tags", ["other"])[0]
                tags.setdefault(tag, []).append(_operation(document, method, path, operation))
    pages = {"reference/index.md": _overview(document)}
    pages |= {f"reference/{tag}.md": f"# {tag.capitalize()}\n\n" + "\n".join(parts) for tag, parts in tags.items()}
    return pages | {"reference/schemas.md": _schemas(document)}


def _overview(document: Document) -> str:
    lines = [
        "# Overview",
        "",
        f"All operations of the API, version {document['info']['version']}. Drawn from `/v1/openapi.json`.",
        "",
        "| | | |",
        "| --- | --- | --- |",
    ]
    for path, item in document["paths"].items():
        for method in OPENAPI_METHODS:
            if method in item:
                operation = item[method]
                page = f"{operation.get('tags', ['other'])[0]}.md#{operation['operationId']}"
                lines.append(
                    f"| `{method.upper()}` | [`{path}`]({page}) | {_first(operation.get('description', ''))} |"
                )
    return "\n".join(lines) + "\n"


def _operation(document: Document, method: str, path: str, operation: Document) -> str:
    lines = [f"## `{method.upper()} {path}` {{#{operation['operationId']}}}", "", operation.get("description", ""), ""]
    if parameters := operation.get("parameters"):
        lines += ["| parameter | in | type | |", "| --- | --- | --- | --- |"]
        for one in parameters:
            needed = " (needed)" if one.get("required") and one["in"] != "path" else ""
            described = _flat(one.get("description", ""))
            lines.append(f"| `{one['name']}` | {one['in']} | {_type(one['schema'])} | {described}{needed} |")
        lines.append("")
    for media, body in operation.get("requestBody", {}).get("content", {}).items():
        lines += [f"Body, `{media}`: {_type(body['schema'])}", ""]
        if "properties" in body["schema"]:
            lines += [*_fields(body["schema"]), ""]
    lines += ["| status | | answer |", "| --- | --- | --- |"]
    for status, answer in sorted(operation["responses"].items()):
        content = answer.get("content", {})
        shown = ", ".join(f"{_type(one.get('schema', {}))} `{media}`".strip() for media, one in content.items())
        lines.append(f"| {status} | {_flat(answer['description'])} | {shown} |")
    return "\n".join(lines) + "\n"


def _schemas(document: Document) -> str:
    lines = ["# Schemas", ""]
    for name, schema in sorted(document["components"]["schemas"].items()):
        lines += [f"## {name} {{#{name.lower()}}}", "", _flat(schema.get("description", "")), ""]
        if "properties" in schema:
            lines += [*_fields(schema), ""]
        elif "enum" in schema:
            lines += [_type(schema), ""]
    return "\n".join(lines).replace("](schemas.md#", "](#") + "\n"


def _fields(schema: Document) -> Iterator[str]:
    yield "| field | type | |"
    yield "| --- | --- | --- |"
    needed = schema.get("required", ())
    for name, one in schema["properties"].items():
        default = f" Default: `{one['default']!r}`." if "default" in one and one["default"] is not None else ""
        mark = " (needed)" if name in needed else ""
        yield f"| `{name}` | {_type(one)} | {_flat(one.get('description', ''))}{default}{mark} |"


def _type(schema: Document) -> str:
    """A schema in a few words, with links to those that have names."""
    if "$ref" in schema:
        name = schema["$ref"].rpartition("/")[2]
        return f"[{name}](schemas.md#{name.lower()})"
    for several in ("anyOf", "oneOf", "allOf"):
        if several in schema:
            return " or ".join(dict.fromkeys(_type(one) for one in schema[several]))
    if "const" in schema:
        return f"`{schema['const']}`"
    if "enum" in schema:
        return ", ".join(f"`{one}`" for one in schema["enum"])
    if schema.get("type") == "array":
        inner = _type(schema["items"]) if schema.get("items") else "anything"
        return f"list of {inner}"
    if isinstance(schema.get("additionalProperties"), dict) and "properties" not in schema:
        return f"object of {_type(schema['additionalProperties'])}"
    known = schema.get("type", "anything" if schema else "")
    bounds = [f"{word} {schema[key]}" for key, word in BOUND_SIGNS.items() if key in schema]
    return " ".join([known, *([f"({schema['format']})"] if "format" in schema else []), *bounds])


BOUND_SIGNS = {
    "minimum": "≥",
    "exclusiveMinimum": ">",
    "maximum": "≤",
    "exclusiveMaximum": "<",
    "minLength": "of at least",
    "maxLength": "of at most",
}


def _flat(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def _first(text: str) -> str:
    return _flat(text).partition(". ")[0].rstrip(".") + "."


def _title(page: str) -> str:
    return page.partition("\n")[0].removeprefix("# ")
