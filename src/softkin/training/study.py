"""Resumable Optuna study of the parameters whose mean error over parts of `train` is lowest."""

from __future__ import annotations

import hashlib
import json
import logging
import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import optuna
import pandas as pd
from filelock import FileLock
from optuna.storages.journal import JournalFileBackend, JournalFileOpenLock, JournalStorage
from optuna.storages.journal._storage import JournalOperation
from optuna.trial import FrozenTrial, Trial, TrialState

from softkin.core.clocks import counted_as_fit
from softkin.core.distributions import installed
from softkin.core.errors import DataError
from softkin.core.files import replacing
from softkin.core.rows import sampled_rows
from softkin.core.samples import Params, Samples
from softkin.data.table import content_hash
from softkin.training.journal import heal, is_of

logger = logging.getLogger("softkin")

#: Libraries whose version can change the score of a trial.
DECIDING_PACKAGES = ("numpy", "scipy", "scikit-learn", "xgboost", "optuna")
ENDED = (TrialState.COMPLETE, TrialState.PRUNED)
#: From the sixth on, a trial goes on only as long as its running mean is among this share (percent) of the complete
#: ones: all trials have the same parts, so the first part nearly decides. `benchmarks/pruning.py` measures the cost.
STARTUP_TRIALS, KEPT_PERCENT = 5, 10.0


@dataclass(frozen=True, slots=True)
class TuningSettings:
    """`n_trials` is the study's total; `n_folds` folds grouped by distinct command; a trial sees `max_rows` rows."""

    n_trials: int
    n_folds: int
    max_rows: int
    seed: int


@dataclass(frozen=True, slots=True)
class TuningResult:
    """Best parameters `params`, their score (mm), the table of all `trials`, the study's fingerprint; parameters and
    scores of all `complete` trials, the best first.
    """

    params: Params
    score_mm: float
    trials: pd.DataFrame
    fingerprint: str
    complete: Sequence[tuple[Params, float]]


def bounded_rows(samples: Samples, max_rows: int, seed: int) -> Samples:
    """At most `max_rows` rows drawn without replacement, in their order."""
    return samples.take(sampled_rows(len(samples), max_rows, seed))


def fingerprint(name: str, samples: Samples, settings: TuningSettings, code: str) -> str:
    """SHA-256 (hex) of all that decides a trial: the search's `name`, the rows of `train`, the settings but for the
    number of trials, the hash `code` of source files, the library versions.
    """
    decides = {
        "search": name,
        "data": content_hash(samples),
        "settings": {key: value for key, value in asdict(settings).items() if key != "n_trials"},
        "code": code,
        "versions": {package: installed(package)[1] for package in DECIDING_PACKAGES},
    }
    return hashlib.sha256(json.dumps(decides, sort_keys=True).encode()).hexdigest()


@dataclass(frozen=True, slots=True)
class Search:
    """What a study searches.

    `space(trial)` draws parameters, after those of `first_trials`; `errors_of(params)` yields the error (mm) on each of
    `n_parts` parts of `train`, whose mean is minimised. `name` holds all else that decides a trial.
    """

    name: str
    space: Callable[[Trial], Params]
    first_trials: Sequence[Mapping[str, Any]]
    errors_of: Callable[[Params], Iterator[float]]
    n_parts: int


@dataclass(frozen=True, slots=True)
class StudyFile:
    """Where a study lives (a journal), and the hash of the `code` that decides its trials."""

    path: str | Path
    code: str


def run_study(samples: Samples, *, search: Search, settings: TuningSettings, file: StudyFile) -> TuningResult:
    """Bring the study in `file` to `settings.n_trials` ended trials and return the best parameters and all trials.

    A trial is pruned as soon as its running mean is too large beside the others', or an error is not finite.

    A study is resumed to the bit: a killed run leaves its ended trials in the file; the next run cuts off a record that
    is torn, marks the unfinished trial as failed and draws it again from a sampler seeded by the number of ended
    trials, and so ends with the same trials as an undisturbed run. A first trial that waits is taken as it is. A file
    of another fingerprint, or that is no journal, is replaced.

    Raises:
        DataError: no trial could be scored.
    """
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    path = Path(file.path).resolve()
    path.parent.mkdir(parents=True, exist_ok=True)
    mark = fingerprint(search.name, samples, settings, file.code)
    # An orphan of a killed workflow may still be writing: the lock goes with the process that holds it.
    with FileLock(f"{path}.lock"):
        study = _open_study(path, mark)
        for unfinished in study.get_trials(deepcopy=False, states=(TrialState.RUNNING,)):
            study.tell(unfinished.number, state=TrialState.FAIL)
        ended = len(study.get_trials(deepcopy=False, states=ENDED))
        if ended:
            logger.info("resuming after %d of %d trials", ended, settings.n_trials)
        while ended < settings.n_trials:
            first = search.first_trials
            if ended < len(first) and not study.get_trials(deepcopy=False, states=(TrialState.WAITING,)):
                study.enqueue_trial(dict(first[ended]))
            study.sampler = optuna.samplers.TPESampler(
                seed=settings.seed + ended, multivariate=True, constant_liar=False
            )
            with counted_as_fit():
                study.optimize(lambda trial: _score(trial, search), n_trials=1)
            ended += 1
            _report_progress(study, ended, settings.n_trials)
        return _result(study.get_trials(deepcopy=False, states=ENDED)[: settings.n_trials], mark, file.path)


def _score(trial: Trial, search: Search) -> float:
    """Mean error (mm) of the parameters that `trial` draws; parameters and times are stored with the trial."""
    start, cpu = time.perf_counter(), time.process_time()
    params = search.space(trial)
    trial.set_user_attr("params", params)
    errors: list[float] = []
    try:
        for step, error in enumerate(search.errors_of(params)):
            errors.append(error)
            if not np.isfinite(error):
                raise optuna.TrialPruned
            trial.report(float(np.mean(errors)), step)
            if step + 1 < search.n_parts and trial.should_prune():
                raise optuna.TrialPruned
    finally:
        trial.set_user_attr("n_parts_scored", len(errors))
        trial.set_user_attr("seconds", time.perf_counter() - start)
        trial.set_user_attr("cpu_seconds", time.process_time() - cpu)
    return float(np.mean(errors))


class _NoLock(JournalFileOpenLock):
    """Locks nothing: the process holds the study already, and a lock that a killed one left would hold up the next."""

    def acquire(self) -> bool:
        return True

    def release(self) -> None:
        pass


class _File(JournalFileBackend):
    """Optuna's file, synced to the disk when a trial ends and not after each of its dozen records: a kill leaves all of
    them, and a power cut takes no trial that has ended.
    """

    def append_logs(self, logs: list[dict[str, Any]]) -> None:
        lines = [json.dumps(log, separators=(",", ":")) + "\n" for log in logs]
        with Path(self._file_path).open("ab") as file:
            file.write("".join(lines).encode())
            if any(log["op_code"] == JournalOperation.SET_TRIAL_STATE_VALUES for log in logs):
                file.flush()
                os.fsync(file.fileno())


def _journal(path: Path) -> JournalStorage:
    return JournalStorage(_File(str(path), _NoLock(str(path))))


def _open_study(path: Path, mark: str) -> optuna.Study:
    """The study of the fingerprint `mark`; where there is none, a new one replaces the file in one step."""
    name = mark[:16]
    if is_of(path, name):
        heal(path)
    else:
        with replacing(path) as temporary:
            optuna.create_study(storage=_journal(temporary), study_name=name)
    pruner = optuna.pruners.PercentilePruner(KEPT_PERCENT, n_startup_trials=STARTUP_TRIALS)
    return optuna.load_study(study_name=name, storage=_journal(path), pruner=pruner)


def _report_progress(study: optuna.Study, ended: int, total: int) -> None:
    trial = study.get_trials(deepcopy=False)[-1]
    logger.debug("trial %d of %d: %s %s %s", ended, total, trial.state.name, trial.value, trial.params)
    if ended == total or ended % max(1, total // 4) == 0:
        scored = [t for t in study.get_trials(deepcopy=False) if t.state == TrialState.COMPLETE]
        best = min((float(t.value) for t in scored if t.value is not None), default=float("nan"))
        logger.info("%d of %d trials, best %.4g mm", ended, total, best)


def _result(trials: list[FrozenTrial], mark: str, path: str | Path) -> TuningResult:
    complete = [trial for trial in trials if trial.state == TrialState.COMPLETE and trial.value is not None]
    if not complete:
        raise DataError(
            f"none of {len(trials)} trials could be scored",
            where=path,
            fix="read in the job's log why trials failed, and check the positions of `train`",
        )
    complete.sort(key=lambda trial: (trial.value, trial.number))
    scored = [(trial.user_attrs["params"], float(trial.value or 0.0)) for trial in complete]
    table = pd.DataFrame([_row(place, trial) for place, trial in enumerate(trials)])
    return TuningResult(*scored[0], table, mark, scored)


def _row(place: int, trial: FrozenTrial) -> dict[str, Any]:
    shown = {f"param_{key}": value for key, value in sorted(trial.params.items())}
    attributes = {key: trial.user_attrs.get(key) for key in ("n_parts_scored", "seconds", "cpu_seconds")}
    # Optuna gives a pruned trial its last running mean as value; only a mean over all parts is a score.
    is_complete = trial.state == TrialState.COMPLETE
    scores = {"score_mm": trial.value if is_complete else None, "first_part_mm": trial.intermediate_values.get(0)}
    return {"trial": place, "state": trial.state.name} | scores | attributes | shown


def record(result: TuningResult) -> dict[str, Any]:
    """What a file of best parameters records of its study."""
    return {
        "n_trials": len(result.trials),
        "n_pruned": int((result.trials["state"] == TrialState.PRUNED.name).sum()),
        "cpu_seconds": float(result.trials["cpu_seconds"].sum()),
        "fingerprint": result.fingerprint,
    }
