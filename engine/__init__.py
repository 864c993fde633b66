"""Galatea's vision and graphics: still pictures of people brought to life, on ordinary CPUs.

Knows nothing of HTTP, queues or databases. The four systems (`engine.portrait`, ...) stand on the
rooms below them (`media`, `perception`, `imaging`, `geometry`, `render`, `body`, `export`) and never
on each other.
"""

__version__ = "0.1.0"
