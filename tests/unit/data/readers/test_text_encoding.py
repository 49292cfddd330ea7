from __future__ import annotations

import pytest

from softkin.core.errors import DataError
from softkin.data.readers.text_encoding import decoded


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_encodings_are_told_by_the_first_bytes(encoding: str) -> None:
    assert decoded("u1,größe\n".encode(encoding), True) == ("u1,größe\n", encoding)


def test_a_letter_that_is_cut_off_counts_only_where_the_file_ends() -> None:
    half = "grö".encode()[:-1]
    assert decoded(half, False)[0] == "gr"
    with pytest.raises(DataError, match="not utf-8"):
        decoded(half, True)


@pytest.mark.parametrize(
    ("content", "says"),
    [("größe".encode("latin-1"), "not utf-8"), ("u1".encode("utf-16-le"), "zero bytes"), (b" \n", "is empty")],
)
def test_what_is_no_text_is_an_error(content: bytes, says: str) -> None:
    with pytest.raises(DataError, match=says) as raised:
        decoded(content, True)
    assert raised.value.fix
