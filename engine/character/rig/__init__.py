"""The surface bound to its skeleton, and what can be said of it (the paper's section 5)."""
