"""Turn a data card from Markdown into HTML for the page."""

from __future__ import annotations

import re
from pathlib import Path

from markdown import Markdown, markdown  # type: ignore[import-untyped]
from markdown.extensions import Extension  # type: ignore[import-untyped]

#: A card's own headings lie below those of the page: its first is left out, since the page has one.
LEVELS = {"<h2>": "<h5>", "</h2>": "</h5>"}
#: A wide table scrolls in a box of its own, which the keyboard reaches.
BOX = '<div class="scroll" tabindex="0" role="region" aria-label="Table of the data card">'
#: An ampersand that is not of `softkin.core.escaping`.
LIVE_AMPERSAND = re.compile(r"&(?!(?:#124|lt|amp);)")


class NoLinks(Extension):  # type: ignore[misc]
    """A card has neither links nor pictures, so what looks like one is somebody's text."""

    def extendMarkdown(self, md: Markdown) -> None:
        """Take from `md` all that makes a link or a picture, of the card's text or of a definition below it."""
        for name in ("link", "image_link", "reference", "image_reference", "short_reference", "short_image_ref"):
            md.inlinePatterns.deregister(name)
        md.inlinePatterns.deregister("autolink")
        md.inlinePatterns.deregister("automail")
        md.parser.blockprocessors.deregister("reference")


def card_page(readable: str | Path) -> str:
    """HTML of a data card in Markdown, without its title. What looks like markup in it, in a title say, is text."""
    text = Path(readable).read_text(encoding="utf-8").split("\n", 1)[1]
    plain = LIVE_AMPERSAND.sub("&amp;", text).replace("<", "&lt;")
    html = markdown(plain, extensions=["tables", NoLinks()], tab_length=2)
    for heading, lower in LEVELS.items():
        html = html.replace(heading, lower)
    return str(html.replace("<table>", f"{BOX}<table>").replace("</table>", "</table></div>"))
