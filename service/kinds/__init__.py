"""The endpoint of the job kinds, from which forms can be drawn."""
