"""Arms that stop at the body that they belong to."""
