"""Fingerprints: SHA-256 of a canonical JSON text, equal for files that say the same."""

from __future__ import annotations

import hashlib
import json
from typing import Any


def sha256_of(content: Any) -> str:
    """The fingerprint of JSON content of lists, objects, integers and text.

    The text is ASCII, without spaces, members in alphabetical order. Numbers that are no integers
    have no canonical text and must not be in it.
    """
    text = json.dumps(content, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode("ascii")).hexdigest()
