"""What the stages of a job tree found: where it lies on a machine, and where copies lie for the other machines."""

from __future__ import annotations

import shutil

from service.context import Context

STAGES_PREFIX = "stages"
"""The prefix in the storage under which the copies lie: `stages/TREE/KEY`."""


def stages_prefix(tree: str) -> str:
    """Where the copies of a tree's stages lie."""
    return f"{STAGES_PREFIX}/{tree}"


def erase(context: Context, tree: str) -> None:
    """Erase all that was found for a job or a tree, here and in the storage; other machines' housekeeping does the
    same for their folders."""
    shutil.rmtree(context.settings.job_folder(tree), ignore_errors=True)
    context.storage.delete_under(stages_prefix(tree))
