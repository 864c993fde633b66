"""The HTTP API and the truth about jobs: one folder per feature. It uses the engine and knows nothing of the worker."""
