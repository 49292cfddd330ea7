"""One peer on one dataset, in the peers' own environment: started by `benchmarks.peers`, and knows nothing of softkin.

    python peer_models.py PEER IN.npz OUT.npz CPU_SECONDS SEED

IN holds `commands` and `positions` of train, which are all that a peer sees, and `asked`, commands of all other rows;
OUT gets `predicted`, the positions there, and the CPU and wall seconds that were used.
"""

from __future__ import annotations

import importlib
import logging
import signal
import sys
import tempfile
import time
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
N_FOLDS = 5
#: Of the budget that one candidate may take with all its folds.
LARGEST_SHARE = 0.2


class OutOfTime(KeyboardInterrupt):
    """A candidate has used up its CPU time; CatBoost makes a KeyboardInterrupt of it."""


def out_of_time(*_: Any) -> None:
    """What the signal of the CPU clock does."""
    raise OutOfTime


def by_cpu(seconds: float) -> float:
    """The seconds, of a clock that stands still while other programs run: libraries take budgets by `time.time`."""
    start = time.time()
    time.time = lambda: start + time.process_time()
    return seconds


def searched(draw: Callable[[Any], Any], commands: Array, positions: Array, seconds: float, seed: int) -> Any:
    """The best of estimators drawn at random until the CPU seconds are spent, by the mean absolute error of five folds,
    fitted again on all rows.
    """
    from sklearn.base import clone
    from sklearn.model_selection import KFold

    rng, start = np.random.default_rng(seed), time.process_time()
    folds = list(KFold(N_FOLDS, shuffle=True, random_state=seed).split(commands))
    best, lowest, drawn = None, np.inf, 0
    signal.signal(signal.SIGPROF, out_of_time)
    while best is None or (left := seconds - time.process_time() + start) > 0:
        candidate, errors = draw(rng), []
        drawn += 1
        try:
            # CPU time: of one candidate at most a share of the budget, and never more than is left of it.
            signal.setitimer(
                signal.ITIMER_PROF, LARGEST_SHARE * seconds if best is None else min(left, LARGEST_SHARE * seconds)
            )
            for fitted, held_out in folds:
                model = clone(candidate).fit(commands[fitted], positions[fitted])
                errors.append(np.abs(model.predict(commands[held_out]) - positions[held_out]).mean())
                if errors[0] > 3 * lowest:
                    break
        except KeyboardInterrupt:
            if signal.getitimer(signal.ITIMER_PROF)[0] > 0:
                raise  # by a person
            continue
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)
        if len(errors) == N_FOLDS and np.mean(errors) < lowest:
            best, lowest = candidate, float(np.mean(errors))
    print(f"{drawn} candidates drawn, the best {best}", flush=True)
    return best.fit(commands, positions)


def random_search(commands: Array, positions: Array, seconds: float, seed: int) -> Any:
    """Plain scikit-learn: polynomials, support vectors, a Gaussian process, forests, boosting, networks."""
    from sklearn.compose import TransformedTargetRegressor
    from sklearn.ensemble import GradientBoostingRegressor, RandomForestRegressor
    from sklearn.gaussian_process import GaussianProcessRegressor
    from sklearn.gaussian_process.kernels import RBF, Matern, WhiteKernel
    from sklearn.linear_model import Ridge
    from sklearn.multioutput import MultiOutputRegressor
    from sklearn.neural_network import MLPRegressor
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import PolynomialFeatures, StandardScaler
    from sklearn.svm import SVR

    n = commands.shape[1]

    def power(rng: Any, low: float, high: float) -> float:
        return float(10 ** rng.uniform(low, high))

    def gaussian_process(rng: Any) -> Any:
        kernel = RBF(np.ones(n)) if rng.random() < 0.5 else Matern(np.ones(n), nu=2.5)
        return GaussianProcessRegressor(kernel + WhiteKernel(1e-4), alpha=1e-10, random_state=seed)

    def forest(rng: Any) -> Any:
        leaf = int(rng.integers(1, 9))
        return RandomForestRegressor(200, min_samples_leaf=leaf, random_state=seed)

    def boosting(rng: Any) -> Any:
        options = {"max_depth": int(rng.integers(2, 7)), "learning_rate": power(rng, -2, -0.5), "subsample": 0.7}
        return MultiOutputRegressor(
            GradientBoostingRegressor(n_estimators=int(rng.integers(100, 800)), random_state=seed, **options)
        )

    def network(rng: Any) -> Any:
        layers = (int(2 ** rng.integers(4, 8)),) * int(rng.integers(1, 4))
        return MLPRegressor(hidden_layer_sizes=layers, alpha=power(rng, -6, -1), max_iter=1000, random_state=seed)

    kinds: list[Callable[[Any], Any]] = [
        lambda rng: make_pipeline(PolynomialFeatures(int(rng.integers(1, 7))), Ridge(power(rng, -8, 2))),
        lambda rng: MultiOutputRegressor(SVR(C=power(rng, -1, 4), gamma=power(rng, -2, 1), epsilon=power(rng, -4, -1))),
        gaussian_process,
        forest,
        boosting,
        network,
    ]

    def draw(rng: Any) -> Any:
        model = make_pipeline(StandardScaler(), kinds[int(rng.integers(len(kinds)))](rng))
        return TransformedTargetRegressor(model, transformer=StandardScaler())

    return searched(draw, commands, positions, seconds, seed)


def catboost(commands: Array, positions: Array, seconds: float, seed: int) -> Any:
    """CatBoost, all coordinates at once, drawn at random like the candidates of `random_search`."""
    from sklearn.compose import TransformedTargetRegressor
    from sklearn.preprocessing import StandardScaler

    library = importlib.import_module("catboost")

    def draw(rng: Any) -> Any:
        model = library.CatBoostRegressor(
            iterations=int(rng.integers(100, 1001)),
            depth=int(rng.integers(2, 7)),
            learning_rate=float(10 ** rng.uniform(-2, -0.5)),
            l2_leaf_reg=float(10 ** rng.uniform(-2, 1)),
            loss_function="MultiRMSE" if positions.shape[1] > 1 else "RMSE",
            thread_count=1,
            random_seed=seed,
            verbose=False,
            allow_writing_files=False,
        )
        return TransformedTargetRegressor(model, transformer=StandardScaler())

    return searched(draw, commands, positions, seconds, seed)


class EachAlone:
    """One fitted model for each coordinate."""

    def __init__(self, models: list[Any], asked: Callable[[Array], Any]) -> None:
        self.models, self.asked = models, asked

    def predict(self, commands: Array) -> Array:
        """Positions (n_rows, n_coordinates)."""
        return np.column_stack([np.asarray(model.predict(self.asked(commands))) for model in self.models])


def flaml(commands: Array, positions: Array, seconds: float, seed: int) -> Any:
    """FLAML's AutoML as it comes, by mean absolute error; each coordinate has its share of the budget."""
    library, models = importlib.import_module("flaml"), []
    share = by_cpu(seconds) / positions.shape[1]
    for coordinate in positions.T:
        model = library.AutoML()
        model.fit(
            commands, coordinate, task="regression", metric="mae", time_budget=share, n_jobs=1, seed=seed, verbose=0
        )
        print(f"best: {model.best_estimator} {model.best_config}", flush=True)
        models.append(model)
    return EachAlone(models, lambda rows: rows)


def autogluon(commands: Array, positions: Array, seconds: float, seed: int) -> Any:
    """AutoGluon tabular as it comes, by mean absolute error; each coordinate has its share of the budget. What it has
    that needs torch is not there. It seeds its models itself, the `seed` is that of numpy.
    """
    np.random.seed(seed)
    import pandas as pd

    library, models = importlib.import_module("autogluon.tabular"), []
    names = [f"u{place + 1}" for place in range(commands.shape[1])]
    share = by_cpu(seconds) / positions.shape[1]
    for coordinate in positions.T:
        folder = tempfile.mkdtemp()
        model = library.TabularPredictor(
            "position", problem_type="regression", eval_metric="mean_absolute_error", path=folder, verbosity=0
        )
        table = pd.DataFrame(commands, columns=names).assign(position=coordinate)
        model.fit(table, time_limit=share, num_cpus=1, num_gpus=0, presets="medium_quality")
        print(f"best: {model.model_best}", flush=True)
        models.append(model)
    return EachAlone(models, lambda rows: pd.DataFrame(rows, columns=names))


PEERS = {"random_search": random_search, "catboost": catboost, "flaml": flaml, "autogluon": autogluon}


def main() -> None:
    """Fit one peer, and write what it predicts."""
    peer, given, written, seconds, seed = sys.argv[1:]
    warnings.filterwarnings("ignore")
    logging.disable(logging.WARNING)
    data = np.load(given)
    cpu, wall = time.process_time(), time.perf_counter()
    model = PEERS[peer](data["commands"], data["positions"], float(seconds), int(seed))
    used = {"cpu_seconds": time.process_time() - cpu, "wall_seconds": time.perf_counter() - wall}
    predicted = np.asarray(model.predict(data["asked"])).reshape(len(data["asked"]), -1)
    np.savez(written, predicted=predicted, **{name: np.array(seconds) for name, seconds in used.items()})  # type: ignore[arg-type]


if __name__ == "__main__":
    main()
