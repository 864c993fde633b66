"""Which job searches a driver for moments"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0010"
down_revision = "0009"
branch_labels = None
depends_on = None


def upgrade() -> None:
    with op.batch_alter_table("drivers") as drivers:
        drivers.add_column(sa.Column("moments_job", sa.String(length=36), nullable=True))
        drivers.create_index("ix_drivers_moments_job", ["moments_job"])


def downgrade() -> None:
    with op.batch_alter_table("drivers") as drivers:
        drivers.drop_index("ix_drivers_moments_job")
        drivers.drop_column("moments_job")
