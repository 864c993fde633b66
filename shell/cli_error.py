"""Bad input at the shell: one clear line, exit code 2."""

from __future__ import annotations

import click


class CliError(click.ClickException):
    """Ends the command with one line on standard error and exit code 2."""

    exit_code = 2
