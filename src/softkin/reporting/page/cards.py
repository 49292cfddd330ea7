"""Turn a data card from Markdown into HTML for the page."""

from __future__ import annotations

from pathlib import Path

from markdown import markdown  # type: ignore[import-untyped]

#: A card's own headings lie below those of the page: its first is left out, since the page has one.
LEVELS = {"<h2>": "<h5>", "</h2>": "</h5>"}
#: A wide table scrolls in a box of its own, which the keyboard reaches.
BOX = '<div class="scroll" tabindex="0" role="region" aria-label="Table of the data card">'


def card_page(readable: str | Path) -> str:
    """HTML of a data card in Markdown, without its title. What looks like markup in it, in a title say, is text."""
    text = Path(readable).read_text(encoding="utf-8").split("\n", 1)[1]
    html = markdown(text.replace("&", "&amp;").replace("<", "&lt;"), extensions=["tables"], tab_length=2)
    for heading, lower in LEVELS.items():
        html = html.replace(heading, lower)
    return str(html.replace("<table>", f"{BOX}<table>").replace("</table>", "</table></div>"))
