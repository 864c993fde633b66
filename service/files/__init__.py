"""Uploaded files: what may come in, how forms are received, and what is kept."""
