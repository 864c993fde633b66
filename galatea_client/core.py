"""What both clients do, each thing once: its request, and how the answer is read. Lines (`lines`) do the waiting."""

from __future__ import annotations

from galatea_client.account import Account
from galatea_client.libraries import Libraries
from galatea_client.requests import J
from galatea_client.works import Works


class Core(Works[J], Libraries[J], Account[J]):
    """The methods of both clients."""
