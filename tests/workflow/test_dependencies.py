"""What a rule depends on: every module that its script loads, and what an edited module makes to be run again."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from softkin.cli.partial_tables import PARTIAL
from softkin.cli.redo import UNFINISHED, redo_damaged
from softkin.core.imported_code import CHOSEN_FROM, WITHOUT_EFFECT, file_of, imported_code, imported_modules
from softkin.core.job_records import record_job, record_of
from softkin.core.manifest import MANIFEST, write_manifest
from tests.conftest import HOUSE
from tests.workflow.conftest import House, copy_house, jobs_of

SCRIPTS = sorted((HOUSE / "workflow" / "scripts").glob("*.py"))
ENTRIES = sorted(path for registry in CHOSEN_FROM for path in file_of(registry).parent.glob("[!_]*.py"))


@pytest.fixture(scope="module")
def loaded() -> dict[str, set[str]]:
    """The modules that every script, and every entry of a registry, loads by running its imports."""
    left_out = ",".join(["softkin", *CHOSEN_FROM])
    command = [sys.executable, str(Path(__file__).with_name("loading.py")), left_out, *map(str, [*SCRIPTS, *ENTRIES])]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return {source: set(modules) - set(WITHOUT_EFFECT) for source, modules in json.loads(done.stdout).items()}


def module_of(path: Path) -> str:
    place = path.relative_to(file_of("softkin").parents[1]).with_suffix("")
    return ".".join(place.parts).removesuffix(".__init__")


@pytest.mark.parametrize("source", [*SCRIPTS, *ENTRIES], ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_the_code_of_a_rule_is_what_its_script_loads(source: Path, loaded: dict[str, set[str]]) -> None:
    """No more and no less, but for modules without effect and for entries that are inputs by themselves."""
    closure = {module_of(path) for path in imported_code(source) if path != source}
    assert closure == loaded[str(source)]


def test_modules_without_effect_import_no_others() -> None:
    for module in WITHOUT_EFFECT:
        assert set(imported_modules(file_of(module))) <= set(WITHOUT_EFFECT), module


MODELS = ("lr", "svr", "huber")
CONFIGURATION = f"""
datasets: [finger]
models: [{", ".join(MODELS)}]
interval_methods: [qr, scp_mapie, scp_crepes, cv_plus, rolling_shells]
"""
#: What follows from rules: the tables and what is made of them.
TABLES = {"build_tables", "draw_campaign_figures", "summarise", "build_report"}
SCORED = {"score", "draw_figures", "track"} | TABLES
CALIBRATED = {"calibrate"} | SCORED
REFITTED = {"refit"} | CALIBRATED
ENSEMBLED = {"fit_ensemble"} | REFITTED
FITTED = {"fit_model"} | ENSEMBLED
QUANTILES = {"fit_quantiles"} | CALIBRATED
ALL = {"prepare", "audit"} | FITTED | QUANTILES
#: A module of each package -> the rules that run again when it is edited.
RERUN = {
    "core/folds.py": FITTED | QUANTILES,
    "core/metrics/pinball.py": QUANTILES,
    "data/readers/published_json.py": ALL,
    "data/audit/stuck_poses.py": {"audit"} | CALIBRATED,
    "models/svr.py": FITTED,
    "models/ensembles/greedy.py": ENSEMBLED,
    "models/target_spaces/curvature.py": FITTED,
    "models/quantile/gradient_boosting.py": QUANTILES,
    "training/ensemble.py": ENSEMBLED,
    "training/refit.py": REFITTED,
    "uncertainty/intervals/split_conformal_crepes.py": CALIBRATED,
    "uncertainty/regions/box.py": CALIBRATED,
    "uncertainty/labelled/adaptive.py": SCORED,
    "evaluation/score_points.py": SCORED,
    "reporting/tables/published.py": TABLES,
    "reporting/figures/ranking.py": {"draw_figures", "draw_campaign_figures", "build_report", "track"},
    "reporting/page/headline.py": {"build_report"},
    "tracking/served_model.py": {"track"},
}
#: In `make campaigns`: another one of the same rules stands above, and the first test sees that their code has it.
TWICE = ("core/metrics/pinball.py", "training/ensemble.py", "evaluation/score_points.py")
EDITED = [pytest.param(module, marks=pytest.mark.slow if module in TWICE else ()) for module in RERUN]
#: Of every package those that decide nothing, and entries that are not configured.
WITHOUT_JOBS = [
    *("core/errors.py", "data/audit/cleaning.py", "data/readers/table_file.py", "data/standins/rod.py"),
    *("models/gaussian_process.py", "models/quantile/xgboost.py", "reporting/__init__.py"),
    *("uncertainty/intervals/gaussian.py", "uncertainty/regions/balls.py", "cli/watching/view.py"),
]


@dataclass(frozen=True)
class Finished:
    """A copy of the repository with the files of a finished run and its configuration; the files are empty but for
    manifests and what the final screen reads.
    """

    house: House
    configuration: Path

    def jobs_after_editing(self, *modules: str) -> list[tuple[str, str]]:
        """(rule, wildcards) of what a run would do if these modules had a line more."""
        files = [self.house.root / "src" / "softkin" / name for name in modules]
        before = {file: file.read_bytes() for file in files}
        try:
            for file, content in before.items():
                file.write_bytes(content + b"# edited\n")
            return self.house.jobs(self.configuration)
        finally:
            for file, content in before.items():
                file.write_bytes(content)


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory, mirror: Path) -> Finished:
    folder = tmp_path_factory.mktemp("finished")
    copy_house(folder / "house")
    work, configuration = folder / "work", folder / "configuration.yaml"
    configuration.write_text(CONFIGURATION)
    house = House(folder / "house", work, mirror)
    status, planned = house.looking("--dry-run", more=configuration)
    assert status == 0, planned
    for line in map(str.strip, planned.splitlines()):
        kind, _, paths = line.partition(": ")
        made = [work / path for path in paths.split(", ") if kind in ("output", "benchmark")]
        for path in made:
            path.parent.mkdir(parents=True, exist_ok=True)
            if path.name == "figures":
                path.mkdir()
            else:
                path.write_text("{}" if path.name == "mlflow_runs.json" else "")  # the final screen reads it
        for path in made:
            if path.name == MANIFEST:
                write_manifest(path, [file for file in made if file != path and path.parent in file.parents])
    recorded = house.forked("--touch", "--forceall", more=configuration)  # the params of each job, the code among them
    assert recorded.returncode == 0, recorded.stdout + recorded.stderr
    return Finished(house, configuration)


def test_nothing_is_to_be_done_when_nothing_is_edited_that_decides_something(finished: Finished) -> None:
    assert finished.jobs_after_editing(*WITHOUT_JOBS) == []


def test_the_folder_of_softkin_and_the_times_of_its_files_do_not_count(finished: Finished, tmp_path: Path) -> None:
    times = {file.relative_to(finished.house.root): file.stat() for file in finished.house.root.rglob("*.py")}
    for file in times:
        os.utime(finished.house.root / file)
    moved = finished.house.root.rename(tmp_path / "moved house")
    try:
        assert House(moved, finished.house.work, finished.house.mirror).jobs(finished.configuration) == []
    finally:
        moved.rename(finished.house.root)
        for file, before in times.items():  # which their bytecode names
            os.utime(finished.house.root / file, ns=(before.st_atime_ns, before.st_mtime_ns))


@pytest.mark.parametrize("module", EDITED)
def test_an_edited_module_reruns_what_it_decides_and_nothing_else(module: str, finished: Finished) -> None:
    jobs = finished.jobs_after_editing(module)
    assert {rule for rule, _ in jobs} == RERUN[module]
    assert len(jobs) == len(set(jobs))
    if module == "models/svr.py":
        assert [wildcards for rule, wildcards in jobs if rule == "fit_model"] == ["dataset=finger, model=svr"]


@pytest.mark.parametrize("change", [Path.unlink, lambda file: file.write_text("changed")], ids=["gone", "changed"])
def test_a_file_that_is_not_as_it_was_written_is_made_anew_by_its_model_alone(
    change: Callable[[Path], object], finished: Finished, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By content, not by time; as a run does it when it starts."""
    work = finished.house.work
    monkeypatch.chdir(work)
    folder = Path("results/finger/svr")
    file, log = folder / "tuned" / "predictions.parquet", "results/logs/fit_model/finger/svr.log"
    record_job(log, [path for path in folder.rglob("*") if path.is_file()])
    try:
        os.utime(file)
        assert redo_damaged(only_say=False)[0] == []
        assert finished.house.jobs(finished.configuration) == []
        change(file)
        assert len(redo_damaged(only_say=False)[0]) == 1
        jobs = finished.house.jobs(finished.configuration)
        assert {rule for rule, _ in jobs} == FITTED
        assert [wildcards for rule, wildcards in jobs if rule == "fit_model"] == ["dataset=finger, model=svr"]
    finally:
        file.write_text("")
        record_of(log).unlink()
        shutil.rmtree(work / UNFINISHED)


@pytest.mark.parametrize("complete", [["finger"], []])
def test_tables_of_what_is_there_score_no_complete_dataset_anew(complete: list[str], finished: Finished) -> None:
    """As a run asks for them when a job of another dataset has failed; of datasets that are not complete the calibrated
    model is not read.
    """
    told = {PARTIAL: json.dumps({"left_out": {}, "complete": complete})}
    planned = finished.house.forked(
        "--dry-run", "results/report.html", more=finished.configuration, more_environment=told
    )
    assert planned.returncode == 0, planned.stdout + planned.stderr
    jobs = {rule for rule, wildcards in jobs_of(planned.stdout + planned.stderr) if "finger" in wildcards}
    assert jobs == (set() if complete else {"score", "draw_figures"})
