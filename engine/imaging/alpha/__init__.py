"""Mattes: how far each pixel belongs to what is before."""
