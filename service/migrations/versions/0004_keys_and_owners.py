"""Keys, and whom everything belongs to"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

from service.auth.tokens import new_link_secret, new_signing_secret
from service.clock import now

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None

LOCAL = "local"


def upgrade() -> None:
    keys = op.create_table(
        "keys",
        sa.Column("id", sa.String(length=36), nullable=False),
        sa.Column("name", sa.String(length=100), nullable=False),
        sa.Column("token_hash", sa.String(length=64), nullable=True),
        sa.Column("hint", sa.String(length=16), nullable=False),
        sa.Column("scopes", sa.JSON(), nullable=False),
        sa.Column("signing_secret", sa.String(length=64), nullable=False),
        sa.Column("link_secret", sa.String(length=64), nullable=False),
        sa.Column("requests_per_minute", sa.Integer(), nullable=True),
        sa.Column("jobs_at_once", sa.Integer(), nullable=True),
        sa.Column("stored_mb", sa.Integer(), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("expires_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("revoked_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("last_used_at", sa.DateTime(timezone=True), nullable=True),
        sa.PrimaryKeyConstraint("id"),
        sa.UniqueConstraint("token_hash", name="key_of_token"),
    )
    local = {
        "id": LOCAL,
        "name": "This machine",
        "hint": "",
        "scopes": ["read", "submit", "admin"],
        "signing_secret": new_signing_secret().reveal(),
        "link_secret": new_link_secret().reveal(),
        "created_at": now(),
    }
    op.bulk_insert(keys, [local])
    for table in ("files", "jobs"):
        with op.batch_alter_table(table) as altered:
            altered.add_column(sa.Column("owner", sa.String(length=36), nullable=False, server_default=LOCAL))
        with op.batch_alter_table(table) as altered:
            altered.alter_column("owner", existing_type=sa.String(length=36), server_default=None)
            altered.create_foreign_key(f"{table}_owner_fkey", "keys", ["owner"], ["id"])
    op.create_index("ix_files_owner", "files", ["owner"])
    op.create_index("jobs_by_owner", "jobs", ["owner", "status"])
    _rebuild("drivers", _drivers(owned=True), f"'{LOCAL}', name, file_id, created_at")
    op.create_index("ix_drivers_file_id", "drivers", ["file_id"])
    _rebuild("idempotency_keys", _idempotency_keys(owned=True), f"'{LOCAL}', key, fingerprint, job_id, created_at")
    op.create_index("ix_idempotency_keys_job_id", "idempotency_keys", ["job_id"])


def downgrade() -> None:
    """Drivers and idempotency keys of others than the local key go: their names need not be unique among all."""
    _rebuild("idempotency_keys", _idempotency_keys(owned=False), "key, fingerprint, job_id, created_at", LOCAL)
    op.create_index("ix_idempotency_keys_job_id", "idempotency_keys", ["job_id"])
    _rebuild("drivers", _drivers(owned=False), "name, file_id, created_at", LOCAL)
    op.create_index("ix_drivers_file_id", "drivers", ["file_id"])
    op.drop_index("jobs_by_owner", "jobs")
    op.drop_index("ix_files_owner", "files")
    for table in ("files", "jobs"):
        with op.batch_alter_table(table) as altered:
            altered.drop_constraint(f"{table}_owner_fkey", type_="foreignkey")
            altered.drop_column("owner")
    op.drop_table("keys")


def _drivers(owned: bool) -> list[sa.schema.SchemaItem]:
    columns: list[sa.schema.SchemaItem] = [
        sa.Column("name", sa.String(length=64), nullable=False),
        sa.Column("file_id", sa.String(length=36), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.ForeignKeyConstraint(["file_id"], ["files.id"]),
    ]
    return _named("name", columns, owned)


def _idempotency_keys(owned: bool) -> list[sa.schema.SchemaItem]:
    columns: list[sa.schema.SchemaItem] = [
        sa.Column("key", sa.String(length=255), nullable=False),
        sa.Column("fingerprint", sa.String(length=64), nullable=False),
        sa.Column("job_id", sa.String(length=36), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.ForeignKeyConstraint(["job_id"], ["jobs.id"], ondelete="CASCADE"),
    ]
    return _named("key", columns, owned)


def _named(name: str, columns: list[sa.schema.SchemaItem], owned: bool) -> list[sa.schema.SchemaItem]:
    """The columns, with a name that is unique for each owner, or for all."""
    if not owned:
        return [*columns, sa.PrimaryKeyConstraint(name)]
    owner = sa.Column("owner", sa.String(length=36), nullable=False)
    return [owner, *columns, sa.PrimaryKeyConstraint("owner", name), sa.ForeignKeyConstraint(["owner"], ["keys.id"])]


def _rebuild(table: str, columns: list[sa.schema.SchemaItem], values: str, owner: str | None = None) -> None:
    """Make a table anew and fill it from the old one, with the rows of one owner or with all."""
    op.rename_table(table, f"old_{table}")
    for index in ("file_id", "job_id"):
        op.execute(f"DROP INDEX IF EXISTS ix_{table}_{index}")
    if op.get_bind().dialect.name == "postgresql":  # the names of constraints stay with the old table
        op.execute(f"ALTER INDEX {table}_pkey RENAME TO old_{table}_pkey")
    op.create_table(table, *columns)
    where = "" if owner is None else f" WHERE owner = '{owner}'"
    op.execute(f"INSERT INTO {table} SELECT {values} FROM old_{table}{where}")  # noqa: S608
    op.drop_table(f"old_{table}")
