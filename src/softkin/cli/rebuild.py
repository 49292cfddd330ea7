"""Build the tables across datasets once more, as the jobs `build_tables` and `summarise` do, and say what differs."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from softkin.campaigns.summary import Layout, summarise
from softkin.cli.differences import differences, other_line
from softkin.core.csv_tables import read_csv
from softkin.core.errors import ResultError
from softkin.core.files import read_json
from softkin.core.job_params import other_params
from softkin.core.job_records import FOLDER, read_record
from softkin.core.narrowing import narrowed
from softkin.core.runs import SEARCHED
from softkin.models import MODELS
from softkin.models.ensembles import ENSEMBLES
from softkin.reporting.tables.build import build_tables
from softkin.reporting.tables.frames import DatasetFiles, PublishedFiles, Tables, read_tables
from softkin.reporting.titles import Titles
from softkin.uncertainty.intervals import INTERVAL_METHODS

#: Numbers of tables that are built from the same files differ by less, relative to their size.
CLOSE = 1e-12
#: What the paper printed, beside softkin.
PUBLISHED = Path(__file__).resolve().parents[3] / "resources" / "published"
#: A dataset's files that the tables are made of, by the names that `DatasetFiles` has.
FILES = {
    "point": "point_metrics.csv",
    "markers": "marker_errors.csv",
    "intervals": "interval_metrics.csv",
    "choice": "interval_choice.csv",
    "conditional": "conditional_coverage.csv",
    "alarms": "alarm_rates.csv",
    "extrapolation": "extrapolation_intervals.csv",
    "spaces": "target_spaces.csv",
    "left_out": "left_out.csv",
    "description": "dataset.json",
    "data_card": "data_card.json",
}


#: Those of some datasets alone, by the parameters of `read_tables`.
OF_SOME = {"recorded": "recorded", "learning": "learning_curve", "orientation": "orientation"}
#: Where a run says with which configuration it was made.
SUMMARY = Path("tables", "summary.json")


def can_be_rebuilt(results: Path) -> bool:
    """Whether a run came as far as its tables and its summary, which has the configuration that they were made with."""
    return (results / SUMMARY).is_file() and _record(results).is_file()


def rebuilt(results: Path) -> list[str]:
    """What differs between the files in results/tables and what the results of the datasets give, a sentence each.

    Raises:
        ResultError: the summary has another configuration than the tables were made with.
    """
    tables = results / "tables"
    config = read_json(results / SUMMARY)["configuration"]
    searched = _searched(results, config)
    _check_params(results, config, searched)
    with tempfile.TemporaryDirectory() as place:
        made = Path(place)
        titles = Titles(
            {name: spec.title for name, spec in (MODELS | ENSEMBLES).items()},
            {name: method.title for name, method in INTERVAL_METHODS.items()},
        )
        frames = _tables(results, config, searched)
        build_tables(frames, titles=titles, folder=made, caution=config.get("caution"))
        _summarise(results, config, made)
        sentences = [_difference(tables / path.name, path) for path in sorted(made.iterdir())]
        known = {path.name for path in made.iterdir()}
    sentences += [
        f"{path} is none of the tables that the results of the datasets give"
        for path in sorted(tables.glob("*.*"))
        if path.name not in known and not path.name.startswith(".")
    ]
    return [sentence for sentence in sentences if sentence]


def _record(results: Path) -> Path:
    return results / FOLDER / "build_tables.json"


def _searched(results: Path, config: Mapping[str, Any]) -> dict[str, list[list[str]]]:
    """[model, preset] of the runs of each dataset that a study stands behind, ensembles last."""
    return {
        dataset: [
            [name, preset]
            for name in [*narrowed(config, "models", dataset), *config.get("ensembles", [])]
            for preset in narrowed(config, "presets", dataset)
            if preset in SEARCHED and (results / dataset / name / preset / "parameters.json").is_file()
        ]
        for dataset in config["datasets"]
    }


def _check_params(results: Path, config: Mapping[str, Any], searched: Mapping[str, Any]) -> None:
    """Check that the tables were made with this configuration, by the hashes that their job recorded."""
    content = read_record(_record(results)) or {"params": {}}
    params = {
        "searched": searched,
        "objective": config["objective"],
        "caution": config.get("caution"),
        "sources": {name: config["sources"][name] for name in config["datasets"]},
    }
    recorded = {name: known for name, known in content["params"].items() if name in params}
    others = other_params(recorded, params)
    if others:
        raise ResultError(
            f"it has not the configuration that the tables were made with: {', '.join(others)}",
            where=results / SUMMARY,
            fix="delete it and run again",
        )


def _tables(results: Path, config: Mapping[str, Any], searched: Mapping[str, list[list[str]]]) -> Tables:
    datasets = config["datasets"]
    return read_tables(
        {name: DatasetFiles(**{key: results / name / file for key, file in FILES.items()}) for name in datasets},
        sources={name: config["sources"][name] for name in datasets},
        parameters={
            (name, model, preset): results / name / model / preset / "parameters.json"
            for name, runs in searched.items()
            for model, preset in runs
        },
        objective=config["objective"],
        **{key: _collected(results, name) for key, name in OF_SOME.items()},
        published=PublishedFiles(
            *(
                PUBLISHED / f"{name}.csv"
                for name in ("point_metrics", "subsets", "interval_metrics", "approaches", "improvements")
            )
        ),
    )


def _collected(results: Path, name: str) -> list[Path]:
    """The files of the datasets that a table has rows of, in their order."""
    table = results / "tables" / f"{name}.csv"
    datasets = dict.fromkeys(read_csv(table)["dataset"]) if table.is_file() else ()
    return [results / dataset / f"{name}.csv" for dataset in datasets]


def _summarise(results: Path, config: Mapping[str, Any], made: Path) -> None:
    of_dataset, of_run = f"{results}/{{dataset}}", f"{results}/{{dataset}}/{{model}}/{{preset}}"
    summarise(
        config,
        Layout(
            table=f"{of_dataset}/table.parquet",
            description=f"{of_dataset}/dataset.json",
            data_card=f"{of_dataset}/data_card.json",
            predictions=f"{of_run}/predictions.parquet",
            intervals=f"{of_dataset}/intervals/{{method}}.parquet",
        ),
        point=made / "point_metrics.csv",
        intervals=made / "interval_metrics.csv",
        choice=made / "interval_choice.csv",
        output=made / "summary.json",
        rows=made / "summary_rows.parquet",
    )


def _difference(stored: Path, made: Path) -> str:
    """What differs between a stored file and the one that was made; empty where nothing does."""
    if not stored.is_file():
        return f"{stored} is not there, and the results of the datasets give it"
    if stored.read_bytes() == made.read_bytes():
        return ""
    if made.suffix == ".csv":
        return next(iter(differences(stored, read_csv(made), CLOSE, all_columns=True)), "")
    return other_line(stored, made)
