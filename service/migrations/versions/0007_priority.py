"""Priority"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0007"
down_revision = "0006"
branch_labels = None
depends_on = None

NORMAL = "2"


def upgrade() -> None:
    with op.batch_alter_table("jobs") as jobs:
        jobs.add_column(sa.Column("priority", sa.SmallInteger(), nullable=False, server_default=NORMAL))
    with op.batch_alter_table("jobs") as jobs:
        jobs.alter_column("priority", existing_type=sa.SmallInteger(), server_default=None)
        jobs.create_index("jobs_in_turn", ["status", "kind", "priority", "id"])


def downgrade() -> None:
    with op.batch_alter_table("jobs") as jobs:
        jobs.drop_index("jobs_in_turn")
        jobs.drop_column("priority")
