"""The data cards as they stand in results/, for the page."""

from __future__ import annotations

from pathlib import Path

from markdown import markdown  # type: ignore[import-untyped]

#: A card's own headings lie below those of the page: its first is left out, since the page has one.
LEVELS = {"<h2>": "<h5>", "</h2>": "</h5>"}


def card_page(readable: str | Path) -> str:
    """HTML of a data card in Markdown, without its title. What looks like markup in it, in a title say, is text."""
    text = Path(readable).read_text(encoding="utf-8").split("\n", 1)[1]
    html = markdown(text.replace("&", "&amp;").replace("<", "&lt;"), extensions=["tables"])
    for theirs, ours in LEVELS.items():
        html = html.replace(theirs, ours)
    return str(html.replace("<table>", '<div class="scroll"><table>').replace("</table>", "</table></div>"))
