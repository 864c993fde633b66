"""Sessions on SQLite and PostgreSQL, and the bringing up to date of the tables."""
