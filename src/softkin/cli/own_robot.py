"""`softkin robot FILE`: one robot of one's own, from its file to its calibrated model, and nothing else."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from softkin.cli import new_robot
from softkin.cli.datasets_file import read_key
from softkin.core.errors import ConfigError


def guess_and_run(
    files: Sequence[str],
    name: str | None,
    options: Sequence[str],
    workflow: Callable[..., int],
    *,
    cores: int,
    few_trials: bool,
    yes: bool,
) -> int:
    """Guess the entry of the robot in `files`, append it once it is confirmed, run that robot, and say how its model is
    asked.

    Parameters:
        files: the robot's file, or files: parts of a row, or trials.
        name: of the dataset; None: that of the file.
        options: of `new_robot`, the name among them where there is one.
        workflow: runs Snakemake with these arguments; returns its exit code.
        cores: jobs at a time.
        few_trials: whether it is a first look, by config/few_trials.yaml.
        yes: whether the entry needs nobody to confirm it.

    Returns:
        The exit code: 0, 2 where the file, the guess or its entry is of no use, else that of the workflow.

    Raises:
        ConfigError: the name is none, or is that of an entry.
    """
    name = new_robot.checked_name(name, files[0])
    if name in read_key(new_robot.DATASETS.read_text(encoding="utf-8"), new_robot.DATASETS, "sources", dict):
        raise ConfigError(
            f"'{name}' is an entry already",
            where=new_robot.DATASETS,
            fix=f"run it by 'softkin run --robot {name}', or choose another name with --name",
        )
    sure = [] if yes else ["--ask"]
    if code := new_robot.main([*options, "--write", *sure, "--", *files]):
        return code
    more = ["--configfile", str(new_robot.FEW_TRIALS)] if few_trials else []
    if code := workflow("--cores", str(cores), "--config", f"datasets=[{name}]", *more):
        return code
    made = Path("results") / name
    print(f"softkin predict {made / 'calibrated_model.joblib'} commands.csv --level 0.9")
    print(f"What was found in its data: {made / 'data_card.md'}")
    return 0
