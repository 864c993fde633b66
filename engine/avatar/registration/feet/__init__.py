"""Feet that stand on the ground, as outlines show them."""
