"""Jobs and their artifacts as they are recorded, found and shown; nothing here changes the course of a job."""
