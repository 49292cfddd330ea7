"""Say whether results are what softkin wrote, and whether the tables are what the stored predictions give.

python -m softkin.cli.verify --in results/demo
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from softkin.cli.rebuild import can_be_rebuilt
from softkin.cli.recompute import recomputed
from softkin.cli.redo import sentences
from softkin.core.job_records import FOLDER, damages, records

#: Tables of a dataset that take fits, resampling or calibration data: their jobs would have to run again.
HELD = (
    *("interval_choice", "conditional_coverage", "alarm_rates", "extrapolation_intervals", "target_spaces"),
    *("left_out", "learning_curve", "recorded", "orientation"),
)


def verify(results: Path) -> list[str]:
    """What is wrong with a folder of `results`, a sentence each; nothing where all is as it should be."""
    if not (results / FOLDER).is_dir():
        return [f"{results / FOLDER} is not there: no job has recorded what it wrote"]
    found = sentences(list(damages(results, thorough=True)))
    found += [f"{path} is no record of a job" for path, content in records(results) if content is None]
    found += [f"{path} was written by no job that is recorded" for path in unrecorded(results)]
    return found + list(recomputed(results))


def unrecorded(results: Path) -> list[Path]:
    """Models and tables below `results` that no record names."""
    known = recorded(results)
    files = [path for ending in ("joblib", "parquet", "csv") for path in results.rglob(f"*.{ending}")]
    own = ("studies", "logs", "benchmarks")
    return sorted(path for path in files if path not in known and path.relative_to(results).parts[0] not in own)


def recorded(results: Path) -> set[Path]:
    """The files that a record names."""
    return {results.parent / name for _, content in records(results) if content for name in content["files"]}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; its exit status is 0 where all is as softkin wrote it, 1 where something is not."""
    parser = argparse.ArgumentParser(prog="verify", description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--in", dest="folder", default=".", help="the folder of the run")
    results = Path(parser.parse_args(arguments).folder) / "results"
    found = verify(results)
    for sentence in found:
        print(f"verify: {sentence}")
    if found:
        print("verify: the next run makes anew what was changed or is gone: make run")
        return 1
    n_files = len(recorded(results))
    print(f"verify: {n_files} files are as they were written, and the tables are what the stored predictions give")
    print(f"verify: {by_hash_alone(results)}")
    return 0


def by_hash_alone(results: Path) -> str:
    """What of the results is compared with the hashes that its jobs recorded, and not computed once more."""
    names = [f"{name}.csv" for name in HELD if any(results.glob(f"*/{name}.csv"))]
    others = "tables of a paper, headline and claims, for want of tables/summary.json"
    tables = [] if can_be_rebuilt(results) else [others]
    return f"by their hashes alone: data, models, studies, predictions, intervals, figures; {', '.join(names + tables)}"


if __name__ == "__main__":
    sys.exit(main())
