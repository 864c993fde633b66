"""Eyeballs behind the irises and lids on them, as frames show them, and lids that close."""
