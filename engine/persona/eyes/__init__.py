"""Eyeballs of a persona, that turn behind its lids."""
