"""Prints the OpenAPI document of this tree's service, without starting it."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path
from typing import Any

from service.app import make_app
from service.context import Context
from service.settings import Settings


def document() -> dict[str, Any]:
    """The document, as a service of default settings serves it."""
    with tempfile.TemporaryDirectory() as folder:
        context = Context.open(Settings(data_dir=Path(folder)))
        try:
            return make_app(context).openapi()
        finally:
            context.close()


def main() -> None:
    print(json.dumps(document(), indent=1))


if __name__ == "__main__":
    main()
