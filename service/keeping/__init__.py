"""Keeping files under names in a library: the endpoints of every library, and the jobs that inspect what is kept."""
