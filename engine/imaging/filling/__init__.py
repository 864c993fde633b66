"""Holes of pictures, filled."""
