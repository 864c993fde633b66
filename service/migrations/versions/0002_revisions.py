"""Revisions"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None


def upgrade() -> None:
    with op.batch_alter_table("jobs") as jobs:
        jobs.add_column(sa.Column("revision_of", sa.String(length=36), nullable=True))
        jobs.add_column(sa.Column("tree", sa.String(length=36), nullable=True))
    op.execute("UPDATE jobs SET tree = id")
    with op.batch_alter_table("jobs") as jobs:
        jobs.alter_column("tree", existing_type=sa.String(length=36), nullable=False)
        jobs.create_index("jobs_by_tree", ["tree", "id"])


def downgrade() -> None:
    with op.batch_alter_table("jobs") as jobs:
        jobs.drop_index("jobs_by_tree")
        jobs.drop_column("tree")
        jobs.drop_column("revision_of")
