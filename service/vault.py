"""Secrets at rest: what the tables keep of them is encrypted where the operator set a key (Fernet: AES-128 in CBC mode
with HMAC-SHA256, https://github.com/fernet/spec)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cryptography.fernet import Fernet, MultiFernet

ENCRYPTED_PREFIX = "fernet:"
"""Begins what is encrypted. No secret in clear begins so."""

STORED_CHARACTERS = 255
"""The longest that a secret becomes, encrypted."""


class SecretUnreadable(Exception):
    """No key that is set opens a secret."""

    def __init__(self) -> None:
        super().__init__(
            "A secret in the database was encrypted with a key that is not set: the operator has to put that key back "
            "into GALATEA_SECRETS_KEY."
        )


@dataclass(frozen=True)
class Secret:
    """A secret of a row, or the knowledge that it cannot be read."""

    clear: str | None = field(repr=False)
    """None where no key opens it."""

    def reveal(self) -> str:
        """The secret itself. Raises `SecretUnreadable`."""
        if self.clear is None:
            raise SecretUnreadable
        return self.clear


class Vault:
    """Encrypts with the first of its keys and opens with all. Without a key it keeps secrets in clear."""

    def __init__(self, keys: Sequence[str] = ()):
        """Raises ValueError if a key is none."""
        self._first = self._all = None
        if keys:
            from cryptography.fernet import Fernet, MultiFernet  # who keeps secrets in clear need not wait for it

            each = [Fernet(key) for key in keys]
            self._first, self._all = each[0], MultiFernet(each)

    def seal(self, clear: str) -> str:
        """What is stored of a secret."""
        return clear if self._first is None else ENCRYPTED_PREFIX + self._first.encrypt(clear.encode()).decode()

    def open(self, stored: str) -> Secret:
        """The secret behind what is stored, be it encrypted or not."""
        return Secret(self._opened(stored, self._all) if stored.startswith(ENCRYPTED_PREFIX) else stored)

    def is_current(self, stored: str) -> bool:
        """Whether `seal` would store it in this manner: by the first key, or in clear where there is none."""
        if not stored.startswith(ENCRYPTED_PREFIX):
            return self._first is None
        return self._opened(stored, self._first) is not None

    @staticmethod
    def _opened(stored: str, by: Fernet | MultiFernet | None) -> str | None:
        if by is None:
            return None
        from cryptography.fernet import InvalidToken

        try:
            return by.decrypt(stored.removeprefix(ENCRYPTED_PREFIX)).decode()
        except InvalidToken:
            return None


def new_key() -> str:
    """A fresh key for `GALATEA_SECRETS_KEY`."""
    from cryptography.fernet import Fernet

    return Fernet.generate_key().decode()
