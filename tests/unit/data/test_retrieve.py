"""Retrieval against a real server on loopback that misbehaves in each way the real ones do."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from softkin.core.errors import DataError, RetrievalError
from softkin.data.download import Patience
from softkin.data.readers.file_bundle import Unpacked
from softkin.data.retrieve import retrieve, take_own_file, take_own_files, why_out_of_reach
from tests.unit.data.misbehaving import CONTENT, SHA256, Server

QUICK = Patience(timeout_seconds=0.5, attempts=2, backoff_seconds=0.01)


def get(destination: Path, *urls: str, mirror: str | None = None) -> str:
    return retrieve(
        dataset="finger",
        file="FINGER.json",
        urls=urls,
        sha256=SHA256,
        destination=destination,
        mirror=mirror,
        patience=QUICK,
    )


@pytest.mark.parametrize(
    ("behaviour", "says", "requests"),
    [
        ("missing", "404", 1),
        ("busy", "503", 2),
        ("slow", "timed out", 2),
        ("wrong", "wrong file: sha256 is", 1),
        ("truncated", "truncated", 2),
    ],
)
def test_a_bad_source_is_named_and_leaves_nothing(
    server: Server, tmp_path: Path, behaviour: str, says: str, requests: int
) -> None:
    with pytest.raises(RetrievalError) as error:
        get(tmp_path / "raw.json", server.url(behaviour))
    for part in ("finger", server.url(behaviour), says, "SOFTKIN_DATA_MIRROR"):
        assert part in str(error.value)
    assert list(tmp_path.iterdir()) == []
    assert len(server.requests) == requests


def test_a_refused_connection_is_named(server: Server, tmp_path: Path) -> None:
    url = server.url("good")
    server.shutdown()
    server.server_close()
    with pytest.raises(RetrievalError, match="connection refused"):
        get(tmp_path / "raw.json", url)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("behaviour", ["busy-once", "truncated-once"])
def test_a_source_that_recovers_is_tried_again(server: Server, tmp_path: Path, behaviour: str) -> None:
    assert get(tmp_path / "raw.json", server.url(behaviour)) == server.url(behaviour)
    assert (tmp_path / "raw.json").read_bytes() == CONTENT
    assert len(server.requests) == 2


def test_sources_are_tried_in_order_mirror_first(server: Server, tmp_path: Path) -> None:
    source = get(tmp_path / "raw.json", server.url("good"), mirror=server.url("missing").removesuffix("/FINGER.json"))
    assert source == server.url("good")
    assert server.requests == ["missing", "good"]
    assert (tmp_path / "raw.json").read_bytes() == CONTENT


def test_a_folder_mirror_serves_without_a_request(server: Server, tmp_path: Path) -> None:
    (tmp_path / "FINGER.json").write_bytes(CONTENT)
    assert get(tmp_path / "out" / "raw.json", server.url("good"), mirror=str(tmp_path)).startswith("mirror")
    assert server.requests == []


def test_a_wrong_file_in_the_mirror_is_not_used(server: Server, tmp_path: Path) -> None:
    (tmp_path / "FINGER.json").write_bytes(CONTENT[:-1])
    assert get(tmp_path / "raw.json", server.url("good"), mirror=str(tmp_path)) == server.url("good")
    assert (tmp_path / "raw.json").read_bytes() == CONTENT


def test_a_wrong_file_does_not_replace_a_right_one(server: Server, tmp_path: Path) -> None:
    (tmp_path / "raw.json").write_bytes(CONTENT)
    with pytest.raises(RetrievalError):
        get(tmp_path / "raw.json", server.url("wrong"))
    assert (tmp_path / "raw.json").read_bytes() == CONTENT


@pytest.mark.parametrize("sha256", [None, SHA256])
def test_a_file_of_ones_own_is_copied(tmp_path: Path, sha256: str | None) -> None:
    (tmp_path / "arm.csv").write_bytes(CONTENT)
    destination = tmp_path / "results" / "raw.json"
    take_own_file(dataset="arm", file=str(tmp_path / "arm.csv"), destination=destination, sha256=sha256)
    assert destination.read_bytes() == CONTENT


@pytest.mark.parametrize(
    ("file", "sha256", "says"),
    [("amr.csv", None, "no such file"), ("arm.csv", "0" * 64, "wrong file: sha256 is"), (".", None, "directory")],
)
def test_a_file_of_ones_own_that_is_not_there_or_not_registered_is_an_error(
    tmp_path: Path, file: str, sha256: str | None, says: str
) -> None:
    (tmp_path / "arm.csv").write_bytes(CONTENT)
    with pytest.raises(RetrievalError) as error:
        take_own_file(dataset="arm", file=str(tmp_path / file), destination=tmp_path / "raw.json", sha256=sha256)
    for part in ("'arm'", says, "\n  fix: "):
        assert part in str(error.value)
    assert [path.name for path in tmp_path.iterdir()] == ["arm.csv"]


@pytest.mark.parametrize("behaviour", ["good", "busy-once", "redirect", "packed"])
def test_what_can_be_retrieved_is_not_out_of_reach(server: Server, tmp_path: Path, behaviour: str) -> None:
    """The server refuses HEAD."""
    asked = {"file": "FINGER.json", "urls": [server.url(behaviour)], "patience": QUICK}
    assert why_out_of_reach(**asked, mirror=None) == []  # type: ignore[arg-type]
    assert get(tmp_path / "raw", server.url(behaviour)) == server.url(behaviour)


@pytest.mark.parametrize(
    ("behaviour", "says"),
    [
        ("missing", "the server answered 404 Not Found"),
        ("busy", r"the server answered 503 Service Unavailable \(2 attempts\)"),
        ("slow", r"timed out.* \(2 attempts\)"),
        ("redirect-file", "another scheme"),
        ("announced", "99999999999 bytes are announced"),
    ],
)
def test_what_is_out_of_reach_has_the_reason_that_retrieving_it_has(
    server: Server, tmp_path: Path, behaviour: str, says: str
) -> None:
    (answer,) = why_out_of_reach(file="FINGER.json", urls=[server.url(behaviour)], mirror=None, patience=QUICK)
    assert re.search(says, answer)
    with pytest.raises(RetrievalError) as error:
        get(tmp_path / "raw", server.url(behaviour))
    assert answer in str(error.value)


@pytest.mark.parametrize("form", ["{}", "file://{}", "file://localhost{}"])
def test_a_folder_may_be_given_as_a_url(tmp_path: Path, form: str) -> None:
    folder = tmp_path / "a mirror"
    folder.mkdir()
    (folder / "FINGER.json").write_bytes(CONTENT)
    place = folder.as_uri().removeprefix("file://") if "file" in form else str(folder)
    assert why_out_of_reach(file="FINGER.json", urls=[], mirror=form.format(place)) == []
    assert get(tmp_path / "raw", mirror=form.format(place)) == f"mirror {folder / 'FINGER.json'}"


def test_a_mirror_without_the_file_and_an_entry_without_urls_say_so(tmp_path: Path) -> None:
    (answer,) = why_out_of_reach(file="FINGER.json", urls=[], mirror=str(tmp_path))
    assert answer == f"mirror {tmp_path / 'FINGER.json'}: no such file"
    assert why_out_of_reach(file="FINGER.json", urls=[], mirror=None) == [
        "its entry names no URL, and there is no mirror"
    ]


def test_no_message_has_a_credential(server: Server, tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level("DEBUG", "softkin")
    urls = [server.url(name).replace("http://", "http://me:hunter22@") + "?token=1a2b3c" for name in ("busy", "good")]
    assert "***" in get(tmp_path / "raw", *urls)
    with pytest.raises(RetrievalError) as error:
        get(tmp_path / "raw", urls[0])
    assert server.authorisations[0] is not None
    for secret in ("hunter22", "1a2b3c"):
        assert secret not in str(error.value) + caplog.text


def test_several_own_files_are_put_in_place_as_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("u_2.csv", "u_10.csv"):
        (tmp_path / name).write_text(name)
    take_own_files(dataset="arm", entry={"files": ["u_*.csv"]}, destination="raw")
    assert [name for part in Unpacked(Path("raw")).parts for name, _ in part] == ["u_2.csv", "u_10.csv"]
    with pytest.raises(RetrievalError, match=r"dataset 'arm', file gone.csv") as raised:
        take_own_files(dataset="arm", entry={"files": ["gone.csv"]}, destination="raw")
    assert "`files`" in str(raised.value)
    with pytest.raises(DataError, match=r"dataset 'arm', `files`: no file is named like 'v_\*.csv'"):
        take_own_files(dataset="arm", entry={"files": ["v_*.csv"]}, destination="raw")
