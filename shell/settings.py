"""Reading the settings where a person reads what is wrong."""

from __future__ import annotations

from pydantic import ValidationError

from service.settings import Settings
from shell.cli_error import CliError


def read_settings(**given: object) -> Settings:
    """The settings of the environment, with what was given on the command line. Raises `CliError`."""
    try:
        return Settings(**{name: value for name, value in given.items() if value is not None})  # type: ignore[arg-type]
    except ValidationError as error:
        first = error.errors()[0]
        if not first["loc"]:
            raise CliError(first["msg"].removeprefix("Value error, ")) from error
        name = "GALATEA_" + "_".join(str(part) for part in first["loc"][:1]).upper()
        raise CliError(f"{name}: {first['msg']}") from error
