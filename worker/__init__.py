"""The Celery worker: leases, the processes that do the work, progress, publishing, sweep and housekeeping."""
