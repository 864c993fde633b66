"""What this installation has on offer: job kinds, what a job of each may take, and what is built in."""
