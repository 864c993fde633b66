"""Masks, their pieces and distances, and what colours tell of them."""
