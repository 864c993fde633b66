"""Public links to what jobs have made."""
