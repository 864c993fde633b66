"""What a worker does again and again beside its jobs: the sweep, housekeeping, the delivery of webhooks."""
