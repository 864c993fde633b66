"""What a job's process may do at most: limits, files, system calls, and who it is."""
