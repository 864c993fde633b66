"""Live portraits: a process of its own for each, walled in as jobs are."""
