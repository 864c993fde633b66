"""Live portraits: a stream of a camera's frames comes in by a WebSocket, the portrait that does the same goes out."""
