"""Other packages that register something, as an installer leaves them on a path."""

from __future__ import annotations

from pathlib import Path


def install(folder: Path, name: str, group: str, entries: dict[str, str], **modules: str) -> None:
    """Put a distribution with entry points and the text of its modules into a folder."""
    info = folder / f"{name}-1.0.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(
        f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n", encoding="utf-8"
    )
    lines = [f"[{group}]", *(f"{entry} = {value}" for entry, value in entries.items())]
    (info / "entry_points.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    for module, text in modules.items():
        (folder / f"{module}.py").write_text(text, encoding="utf-8")
