"""The endpoints of what jobs have made: one by one, or all as a zip."""
