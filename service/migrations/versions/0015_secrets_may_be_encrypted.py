"""Secrets may be encrypted: there is room for what that makes of them"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import context, op

revision = "0015"
down_revision = "0014"
branch_labels = None
depends_on = None

SECRETS = (
    ("keys", "signing_secret", 64, False),
    ("keys", "link_secret", 64, False),
    ("webhooks", "secret", 100, False),
    ("webhooks", "previous_secret", 100, True),
)
ROOM = 255


def upgrade() -> None:
    for name, column, room, nullable in SECRETS:
        with op.batch_alter_table(name) as table:
            table.alter_column(column, type_=sa.String(ROOM), existing_type=sa.String(room), existing_nullable=nullable)


def downgrade() -> None:
    """The older release knows nothing of keys for secrets: it gets them in clear, or not at all."""
    vault, connection = context.config.attributes["vault"], op.get_bind()
    for name, column, room, nullable in SECRETS:
        stored = sa.table(name, sa.column("id"), sa.column(column))
        kept = sa.select(stored.c.id, stored.c[column]).where(stored.c[column].is_not(None))
        for id_, text in connection.execute(kept).all():
            clear = {column: vault.open(text).reveal()}
            connection.execute(sa.update(stored).where(stored.c.id == id_).values(clear))
        with op.batch_alter_table(name) as table:
            table.alter_column(column, type_=sa.String(room), existing_type=sa.String(ROOM), existing_nullable=nullable)
