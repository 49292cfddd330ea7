"""Other people's search beside softkin: the same rows, the same CPU time each, the same split conformal step.

    python -m benchmarks.peers --minutes 2 [--results results] [--folder results/peers] [--peers ...] [--datasets ...]

Reads the tables of a finished run of the default configuration. Every peer is given the rows of train, and nothing
else; its constant intervals are calibrated on validation, coordinate by coordinate, by the exact rank that softkin
uses. It runs alone on one thread, in an environment of its own in FOLDER, which is made at the first call, and takes
`--minutes` of CPU time of each dataset, or what one candidate takes. What was measured stays in FOLDER, and is not
measured again at the same minutes and seed. Writes docs/peers.md: --page writes it from what is there, measuring
nothing.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.peer_dataset import NEW, Dataset
from benchmarks.peer_models import PEERS

PAGE = Path(__file__).parents[1] / "docs" / "peers.md"
#: What is installed for the peers; AutoGluon without torch has its trees, neighbours and linear models.
PACKAGES = ("scikit-learn", "catboost", "flaml[automl]", "autogluon.tabular[lightgbm,catboost]")
DATASETS = ("finger", "abaqus", "elastica_2023_09", "elastica")
TITLES = {
    "random_search": "scikit-learn, random search",
    "catboost": "CatBoost, random search",
    "flaml": "FLAML",
    "autogluon": "AutoGluon tabular",
}
HEAD = """# Beside peers

Made by `python -m benchmarks.peers --minutes {minutes:g}`, which `make benchmark-peers` runs with two minutes, from a
finished run of the default configuration; no number in it is written by hand. Each peer was given {minutes:g} CPU min
per dataset on one thread, seed {seed}, and the rows of `train` alone; the last fit and what a library takes beyond its
budget come on top, and AutoGluon stops when its models are fitted. *CPU min* is what was used. That of what softkin
deploys is its whole run for the robot: every model, preset, interval and figure. *Its cheapest models* are softkin with
the peers' budget: the models whose searches and fits took least, as many as the budget holds, and of their runs the one
that softkin's own rule chooses by scores on `train`. Budgets are CPU time: for each second of it {ratio:.1f} s passed,
as the machine was shared.

All get constant intervals at 90 % by the same split conformal step on `validation`, per coordinate. *softkin, `auto`*
is what softkin deploys in place of that. Errors, coverage and Winkler scores are means over moving coordinates, in mm;
coverage at 90 % is promised on `test` only. The best of each column is bold, of the Winkler scores, too, whatever the
coverage. Rows of ELASTICA's `test` stand in `train` (the leak of its data card): errors there are training errors.

The dataset authors' kinematics-informed network (Yoon et al. 2024) has no row: their repository publishes training
logs of it in units of its loss, and no errors in mm on these subsets; training it needs torch and their code.
"""
COLUMNS = (
    "| | CPU min | RMSE test | MAE test | RMSE outside | MAE outside "
    "| coverage test, outside | Winkler test | Winkler outside |"
)


def environment(folder: Path) -> Path:
    """The interpreter of the peers' environment, which is made where there is none."""
    python, done = folder / "venv" / "bin" / "python", folder / "venv" / "installed"
    if not done.is_file():
        subprocess.run([sys.executable, "-m", "venv", folder / "venv"], check=True)
        pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        subprocess.run([*map(str, pip), *PACKAGES], check=True)
        done.touch()
    return python


def measured(dataset: Dataset, peer: str, folder: Path, options: argparse.Namespace) -> dict[str, Any]:
    """What a peer reaches on a dataset: scores, and what it used."""
    name = f"{dataset.folder.name}.{peer}.{options.minutes:g}.{options.seed}"
    record, given, written = (folder / f"{name}{end}" for end in (".json", ".in.npz", ".out.npz"))
    if not record.is_file():
        np.savez(given, **dataset.given())  # type: ignore[arg-type]
        script = Path(__file__).with_name("peer_models.py")
        clean = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "PYTHONHOME")}
        command = [folder / "venv" / "bin" / "python", script, peer, given, written]
        with (folder / f"{name}.log").open("w") as log:
            subprocess.run(
                [*map(str, command), str(60 * options.minutes), str(options.seed)],
                env=clean | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "LOKY_MAX_CPU_COUNT": "1"},
                stdout=log,
                stderr=subprocess.STDOUT,
                check=True,
            )
        out = dict(np.load(written))
        found = dataset.scores(out["predicted"]) | {key: float(out[key]) for key in ("cpu_seconds", "wall_seconds")}
        record.write_text(json.dumps({"peer": TITLES[peer]} | found))
    return dict(json.loads(record.read_text()))


def page(
    of_datasets: Mapping[str, Sequence[Mapping[str, Any]]],
    options: argparse.Namespace,
    versions: str,
    missing: Sequence[str],
) -> str:
    """The page of what was measured: dataset -> a row of scores each, and what is `missing`."""
    timed = [row for rows in of_datasets.values() for row in rows if "wall_seconds" in row]
    ratio = sum(row["wall_seconds"] for row in timed) / max(sum(row["cpu_seconds"] for row in timed), 1e-9)
    lines = [HEAD.format(minutes=options.minutes, seed=options.seed, ratio=ratio)]
    keys = [f"{subset}_{name}" for name in ("rmse", "mae") for subset in NEW] + [f"{subset}_winkler" for subset in NEW]
    for title, rows in of_datasets.items():
        best = {key: min(row[key] for row in rows) for key in keys}
        lines += [f"\n## {title}\n", COLUMNS, "| --- " * 9 + "|"]
        lines += [_line(row, best) for row in rows]
    lines.append(f"\n## Versions\n\n{versions}\n")
    if missing:
        lines.append("## Not measured\n\n" + "\n".join(f"- {one}" for one in missing) + "\n")
    return "\n".join(lines)


def _line(row: Mapping[str, Any], best: Mapping[str, float]) -> str:
    def cell(key: str) -> str:
        text = f"{row[key]:.3g}"
        return f"**{text}**" if text == f"{best[key]:.3g}" else text

    errors = [cell(f"{subset}_{name}") for subset in NEW for name in ("rmse", "mae")]
    coverage = ", ".join(f"{100 * row[f'{subset}_coverage']:.1f}" for subset in NEW) + " %"
    scores = [cell(f"{subset}_winkler") for subset in NEW]
    return "| " + " | ".join([row["peer"], f"{row['cpu_seconds'] / 60:.1f}", *errors, coverage, *scores]) + " |"


def main() -> None:
    """Measure, and write the page."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--minutes", type=float, default=2.0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--results", type=Path, default=Path("results"))
    parser.add_argument("--folder", type=Path, default=Path("results/peers"))
    parser.add_argument("--datasets", nargs="+", default=DATASETS)
    parser.add_argument("--peers", nargs="+", default=list(PEERS), choices=list(PEERS))
    parser.add_argument("--page", action="store_true", help="measure nothing: write the page from what is there")
    options = parser.parse_args()
    folder = options.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    python = folder / "venv" / "bin" / "python" if options.page else environment(folder)
    of_datasets, missing = {}, []
    for name in options.datasets:
        dataset = Dataset(options.results / name)
        rows = [*dataset.softkin(), *filter(None, [dataset.cheapest(60 * options.minutes)])]
        for peer in options.peers:
            is_there = (folder / f"{name}.{peer}.{options.minutes:g}.{options.seed}.json").is_file()
            if is_there or not options.page:
                rows.append(measured(dataset, peer, folder, options))
                print(name, json.dumps(rows[-1]), flush=True)
            else:
                missing.append(f"{name}: {TITLES[peer]}")
        if any("wall_seconds" in row for row in rows):
            of_datasets[dataset.title] = rows
    PAGE.write_text(page(of_datasets, options, versions_in(python), missing), encoding="utf-8")


def versions_in(python: Path) -> str:
    """The versions of the peers, a line each."""
    names = ("scikit-learn", "catboost", "flaml", "autogluon.tabular", "lightgbm", "xgboost", "torch")
    code = "import importlib.metadata as m\nfound = {d.name.lower(): d.version for d in m.distributions()}\n"
    code += f"print('\\n'.join(f'- {{n}} {{found.get(n, \"(not installed)\")}}' for n in {names!r}))"
    return subprocess.run([python, "-I", "-c", code], check=True, capture_output=True, text=True).stdout.strip()


if __name__ == "__main__":
    main()
