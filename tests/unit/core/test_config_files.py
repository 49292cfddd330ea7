from __future__ import annotations

from pathlib import Path

import pytest

from softkin.core.config_files import check_config_files
from softkin.core.errors import ConfigError
from tests.conftest import HOUSE


def test_the_shipped_files_say_one_thing() -> None:
    check_config_files((HOUSE / "config").glob("*.yaml"))


@pytest.mark.parametrize(
    "text",
    [
        "a: 1\nb: {a: 2}\nc: [{a: 1}, {a: 2}]\n",  # the same key at other places
        "base: &base {a: 1, b: 2}\nmore:\n  <<: *base\n  a: 3\nagain:\n  <<: *base\n",  # merged keys may be replaced
        "time: '1:30'\nnumber: 0.5\nnone: 0\nhex: 0x1F\nnegative: -0.5\n",
        '{"a": 1, "b": [1.5, "x"]}',
        "\ufeffa: 1\n",
    ],
)
def test_a_file_that_says_one_thing_is_accepted(tmp_path: Path, text: str) -> None:
    path = tmp_path / "more.yaml"
    path.write_text(text)
    check_config_files([path])


def test_the_first_bad_file_is_named_with_its_line(tmp_path: Path) -> None:
    for name, text in (("good.yaml", "a: 1\n"), ("bad.yaml", "a: 1\nb:\n  c: 1\n  c: 2\n")):
        (tmp_path / name).write_text(text)
    with pytest.raises(ConfigError) as error:
        check_config_files([tmp_path / "good.yaml", tmp_path / "bad.yaml"])
    assert error.value.where == f"{tmp_path / 'bad.yaml'}, line 4"
