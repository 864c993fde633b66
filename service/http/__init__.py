"""What all endpoints share of HTTP: bodies, ranges, content codings, and what browsers are told."""
