"""Joints, what hangs on them, and what moves vertices."""
