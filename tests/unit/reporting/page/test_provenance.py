from __future__ import annotations

import subprocess
from pathlib import Path

import yaml

from softkin import __version__
from softkin.reporting.page.provenance import citations, commit, data_grid, settings, versions, what_was_run
from tests.conftest import HOUSE
from tests.unit.reporting.page.frames import NO_MARKS, texts


def git(folder: Path, *arguments: str) -> str:
    who = ["-c", "user.name=me", "-c", "user.email=me@example.org"]
    done = subprocess.run(["git", "-C", str(folder), *who, *arguments], check=True, capture_output=True, text=True)
    return done.stdout.strip()


def test_commit_and_whether_it_is_all(tmp_path: Path) -> None:
    assert commit(tmp_path) is None
    git(tmp_path, "init", "-q")
    assert commit(tmp_path) is None  # nothing committed yet
    (tmp_path / "file").write_text("one")
    git(tmp_path, "add", "file")
    git(tmp_path, "commit", "-q", "-m", "first")
    head = git(tmp_path, "rev-parse", "HEAD")
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "new").write_text("not known to git")
    assert commit(tmp_path) == (head, False)
    (tmp_path / "file").write_text("two")
    assert commit(tmp_path) == (head, True)
    assert commit(tmp_path / "results") is None  # a folder within another checkout


def test_versions_are_those_installed() -> None:
    installed = versions()
    assert installed["softkin"] == __version__
    assert {"Python", "scikit-learn", "optuna", "mapie"} <= set(installed)
    assert "pytest" not in installed


def test_settings_can_be_run_again_and_hold_nothing_private() -> None:
    public = {"campaign": "c", "seed": 3, "models": ["lr", "gp"], "tuning": {"n_trials": 6}}
    text = settings(public | {"data_mirror": "/x", "tracking_uri": "sqlite:///y", "sources": {}})
    assert yaml.safe_load(text) == public
    assert "models: [lr, gp]" in text


def test_citations_of_softkin_and_of_each_dataset_once() -> None:
    sources = {"one": {"citation": "Someone (2023).\n"}, "two": {"citation": "Someone (2023)."}}
    cited = citations(HOUSE / "CITATION.cff", sources)
    assert cited[-1] == "Someone (2023)."
    assert cited.count("Someone (2023).") == 1
    assert cited[0].startswith("The softkin authors. softkin")
    assert any("Jiang, Zhanhong; Shah, Dylan" in text for text in cited)


def test_a_robot_that_asks_for_no_citation_has_none(tmp_path: Path) -> None:
    """One's own, or a stand-in."""
    cff = tmp_path / "CITATION.cff"
    cff.write_text("title: softkin\nauthors: [{name: The authors}]\n")
    assert citations(cff, {"my_arm": {"title": "My arm"}}) == ["The authors. softkin."]


def test_data_are_identified_by_the_hash_of_their_file() -> None:
    rows = {"train": 704, "validation": 88, "test": 89, "extrapolation": 100}
    description = {"title": "ARM", "n_commands": 2, "n_markers": 3, "rows": rows, "sha256": "ab" * 32}
    sources = {"arm": {"file": "arm.json"}}
    for constant, text in (([], "none"), (["m1_x", "m1_y"], "m1_x, m1_y")):
        grid = data_grid({"arm": description | {"constant_coordinates": constant}}, sources, NO_MARKS)
        (row,) = grid.rows
        assert texts(row) == ["arm", "ARM", "2", "3", "704", "88", "89", "100", text, "arm.json", "ab" * 32]
    assert len(grid.columns) == len(row)
    assert "gets by its entry" not in grid.sentence
    own = {"arm": {"file": "arm.json", "presets": ["tuned"], "models": ["gp", "lr"]}}
    said = data_grid({"arm": description | {"constant_coordinates": []}}, own, NO_MARKS).sentence
    assert said.endswith("Of what is configured, arm gets by its entry alone: models gp, lr; presets tuned.")


def test_what_was_run_has_a_value_for_each_name_of_the_template(tmp_path: Path) -> None:
    cff = tmp_path / "CITATION.cff"
    cff.write_text("title: softkin\nauthors: [{name: The authors}]\n")
    run = what_was_run({"campaign": "nightly", "seed": 3}, cff, {})
    assert (run["campaign"], run["seed"], run["commit"]) == ("nightly", 3, None)
    assert run["citations"] == ["The authors. softkin."]
    assert run["written"].endswith("UTC")
    template = (HOUSE / "src" / "softkin" / "reporting" / "page" / "templates" / "page.html.j2").read_text()
    assert all(name in template for name in run)
