"""The engine compiled once before the first job, and who waits for it told so."""
