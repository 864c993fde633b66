"""Titles of jobs, and the words by which they are found"""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator
from typing import Any

import sqlalchemy as sa
from alembic import op

revision = "0012"
down_revision = "0011"
branch_labels = None
depends_on = None

AT_ONCE = 500


def upgrade() -> None:
    with op.batch_alter_table("jobs") as jobs:
        jobs.add_column(sa.Column("title", sa.String(length=200), nullable=True))
        jobs.add_column(sa.Column("search", sa.Text(), nullable=False, server_default=""))
    _fill()
    with op.batch_alter_table("jobs") as jobs:
        jobs.alter_column("search", existing_type=sa.Text(), existing_nullable=False, server_default=None)


def downgrade() -> None:
    with op.batch_alter_table("jobs") as jobs:
        jobs.drop_column("search")
        jobs.drop_column("title")


def _fill() -> None:
    """Note the words of the jobs that are there: an empty title, the kind, what was given, the built-in motion."""
    connection = op.get_bind()
    jobs = sa.table(
        "jobs",
        sa.column("id", sa.String),
        sa.column("kind", sa.String),
        sa.column("inputs", sa.JSON),
        sa.column("options", sa.JSON),
        sa.column("search", sa.Text),
    )
    files = sa.table("files", sa.column("id", sa.String), sa.column("name", sa.String))
    last = ""
    while True:
        query = sa.select(jobs.c.id, jobs.c.kind, jobs.c.inputs, jobs.c.options).where(jobs.c.id > last)
        some = connection.execute(query.order_by(jobs.c.id).limit(AT_ONCE)).all()
        if not some:
            return
        last = some[-1].id
        given = {value for job in some for value in _values(job.inputs)}
        names: dict[str, str] = {}
        for ids in _portions(sorted(given)):
            found = connection.execute(sa.select(files.c.id, files.c.name).where(files.c.id.in_(ids)))
            names |= {one.id: one.name for one in found}
        for job in some:
            motion = job.options.get("motion")
            told = [names.get(value, value) for value in _values(job.inputs)]
            lines = ["", job.kind, *told, *([motion] if isinstance(motion, str) else [])]
            text = "\n".join(" ".join(_folded(line).split()) for line in lines)
            connection.execute(sa.update(jobs).where(jobs.c.id == job.id).values(search=text))


def _values(inputs: dict[str, Any]) -> list[str]:
    return [one for value in inputs.values() for one in (value if isinstance(value, list) else [value])]


def _portions(values: list[str]) -> Iterator[list[str]]:
    for start in range(0, len(values), AT_ONCE):
        yield values[start : start + AT_ONCE]


def _folded(text: str) -> str:
    return unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", text).casefold())
