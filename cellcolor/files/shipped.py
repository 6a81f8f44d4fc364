"""Where the files are that come with the package: the folders ``instances`` and ``models``.

In a repository they lie beside the package; a wheel has the same two folders inside the package, so
that the files' references to each other hold there as well.
"""

from __future__ import annotations

from pathlib import Path


def shipped_folder() -> Path:
    """The folder that has ``instances`` and ``models``."""
    package = Path(__file__).parents[1]
    inside = package / "shipped"
    return inside if inside.is_dir() else package.parent
