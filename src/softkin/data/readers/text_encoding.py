"""Which encoding a text file has: UTF-8 or UTF-16, by its first bytes."""

from __future__ import annotations

import codecs

from softkin.core.errors import DataError

_ENCODINGS = {codecs.BOM_UTF8: "utf-8-sig", codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}


def decoded(start: bytes, is_whole: bool) -> tuple[str, str]:
    """The text of the first bytes of a file, and its encoding.

    Raises:
        DataError: no text, or none at all.
    """
    encoding = next((name for mark, name in _ENCODINGS.items() if start.startswith(mark)), "utf-8")
    try:
        text = codecs.getincrementaldecoder(encoding)().decode(start, final=is_whole)
    except UnicodeDecodeError as error:
        line = start[: error.start].count(b"\n") + 1
        raise DataError(
            f"not {encoding}: {error.reason} (byte {start[error.start]:#04x})",
            where=f"line {line}",
            fix="save the file as 'CSV UTF-8', or write its header in plain letters",
        ) from error
    if "\0" in text:
        line = text[: text.index("\0")].count("\n") + 1
        raise DataError(
            "zero bytes: the file is UTF-16 without its mark, or no text",
            where=f"line {line}",
            fix="save the file as 'CSV UTF-8'",
        )
    if not text.strip():
        raise DataError("the file is empty", fix="export it again, with a header and rows of numbers")
    return text, encoding


def in_utf8(start: bytes) -> bytes:
    """The first bytes of a file, in UTF-8 where they are UTF-16 by its mark; others as they are."""
    if start.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return start.decode("utf-16", errors="ignore").encode()
    return start
