"""One attempt at a job under a lease: prepared, watched over, told of, concluded."""
