"""One page about several planned motions: their reports beside each other."""

from __future__ import annotations

import html
from collections.abc import Mapping

from cellcolor.files.writing import MARKER

_STYLE = """
:root { color-scheme: light dark; }
body { font: 15px/1.5 system-ui, sans-serif; margin: 1rem; display: grid; gap: 1rem;
  grid-template-columns: repeat(auto-fit, minmax(min(100%, 36rem), 1fr)); }
figure { margin: 0; }
iframe { width: 100%; height: 60rem; border: 1px solid #8888; border-radius: 8px; }
"""


def render_side_by_side(pages: Mapping[str, str]) -> bytes:
    """The page, complete in itself; the same reports give the same bytes.

    Args:
        pages: the report of each plan, by its name.
    """
    frames = [
        f"<figure><figcaption>{html.escape(name)}</figcaption>"
        f'<iframe title="{html.escape(name)}" srcdoc="{html.escape(page)}"></iframe></figure>'
        for name, page in pages.items()
    ]
    title = html.escape(f"{len(pages)} plans: {', '.join(pages)}")
    return (
        f'<!doctype html>\n<html lang="en">\n<head><meta name="generator" content="{MARKER}" />\n'
        '<meta charset="utf-8" />\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1" />\n'
        f"<title>{title}</title>\n<style>{_STYLE}</style>\n</head>\n"
        f"<body>\n{''.join(frames)}\n</body>\n</html>\n"
    ).encode()
