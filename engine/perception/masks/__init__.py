"""Masks: where people, what stands out, or a drawn figure are in a picture."""
