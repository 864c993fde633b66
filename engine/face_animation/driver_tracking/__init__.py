"""The driver: its face followed, refined, and its frame at rest."""
