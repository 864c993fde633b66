"""Connections: how many there may be, how long they may bring nothing, and how they end."""
