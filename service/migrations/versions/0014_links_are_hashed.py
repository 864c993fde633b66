"""Of the tokens of public links only hashes are kept; links of revoked keys are gone"""

from __future__ import annotations

import hashlib

import sqlalchemy as sa
from alembic import op

revision = "0014"
down_revision = "0013"
branch_labels = None
depends_on = None

HINT_CHARACTERS = 6


def upgrade() -> None:
    with op.batch_alter_table("public_links") as links:
        links.alter_column("token", new_column_name="token_hash", existing_type=sa.String(length=64))
        links.add_column(sa.Column("hint", sa.String(length=16), nullable=False, server_default=""))
    op.execute("DELETE FROM public_links WHERE owner IN (SELECT id FROM keys WHERE revoked_at IS NOT NULL)")
    connection = op.get_bind()
    rows = sa.table("public_links", sa.column("id"), sa.column("token_hash"), sa.column("hint"))
    for link, token in connection.execute(sa.select(rows.c.id, rows.c.token_hash)).all():
        hashed = hashlib.sha256(token.encode()).hexdigest()
        values = {"token_hash": hashed, "hint": token[:HINT_CHARACTERS]}
        connection.execute(sa.update(rows).where(rows.c.id == link).values(values))
    with op.batch_alter_table("public_links") as links:
        links.alter_column("hint", existing_type=sa.String(length=16), existing_nullable=False, server_default=None)
        links.create_index("ix_public_links_owner", ["owner"])


def downgrade() -> None:
    op.execute("DELETE FROM public_links")  # nobody knows their tokens any more
    with op.batch_alter_table("public_links") as links:
        links.drop_index("ix_public_links_owner")
        links.drop_column("hint")
        links.alter_column("token_hash", new_column_name="token", existing_type=sa.String(length=64))
