"""The tables of a finished run, cut to what `make numbers` prints and what the results page shows."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from softkin.core.csv_tables import read_csv
from softkin.core.errors import DataError
from softkin.core.runs import PAPER, PAPERS_LEVEL, TUNED
from softkin.core.samples import EXTRAPOLATION, TEST

RUN = ["dataset", "model", "preset"]
PAPERS_METHODS = ("qr", "cqr", "scp_mapie")
ONE_FOR_EVERYWHERE = "auto"


@dataclass(frozen=True, slots=True)
class RunTables:
    """The CSV tables of a run, in `folder`, at one confidence `level`."""

    folder: Path
    level: float = PAPERS_LEVEL

    def read(self, name: str, *texts: str) -> pd.DataFrame:
        """A table of the run; its columns `texts` as they are written.

        Raises:
            DataError: the run has not made it.
        """
        path = self.folder / f"{name}.csv"
        if not path.is_file():
            raise DataError("no such table", where=path, fix="run the default configuration first: make run")
        return read_csv(path, dtype=dict.fromkeys(texts, str))

    def at_level(self, name: str) -> pd.DataFrame:
        """The rows of a table at the confidence level."""
        frame = self.read(name)
        return frame[frame["confidence_level"] == self.level]

    def deployed(self) -> pd.DataFrame:
        """The deployed run of each dataset, with its target space."""
        selection = self.read("selection")
        return selection.loc[selection["deployed"], [*RUN, "target_space"]]

    def deployed_in_extrapolation(self) -> pd.DataFrame:
        """Errors (mm) of the deployed runs in extrapolation; how well scores on `train` ranked them."""
        scores = self.read("point_metrics")
        errors = scores.loc[scores["subset"] == EXTRAPOLATION, [*RUN, "rmse_mm", "mae_mm"]]
        ranks = self.read("searched_runs").groupby("dataset")[["shell_rank_correlation", "cv_rank_correlation"]].first()
        return self.deployed().merge(errors, on=RUN).merge(ranks, on="dataset")

    def space_ratios(self) -> pd.DataFrame:
        """RMSE in extrapolation, in curvature coordinates over in positions: a row per model, a column per dataset."""
        spaces = self.read("target_spaces")
        wide = spaces[spaces["subset"] == EXTRAPOLATION].pivot_table(
            index="model", columns=["dataset", "target_space"], values="rmse_mm", sort=False
        )
        names = spaces["dataset"].unique()
        return pd.DataFrame({name: wide[name, "curvature"] / wide[name, "cartesian"] for name in names})

    def errors_by_preset(self, model: str) -> pd.DataFrame:
        """RMSE (mm) of a model in extrapolation, a row per dataset, a column per preset."""
        scores = self.read("point_metrics")
        of_model = scores[(scores["subset"] == EXTRAPOLATION) & (scores["model"] == model)]
        return of_model.pivot_table(index="dataset", columns="preset", values="rmse_mm")

    def chosen_intervals(self) -> pd.DataFrame:
        """The chosen and the deployed interval method of each dataset, with their scores on `test`."""
        choice = self.read("interval_choice")
        names = [*RUN, "interval_method", "chosen", "deployed"]
        shown = choice[choice["chosen"] | choice["deployed"]]
        scores = ["test_coverage", "test_winkler_mm", "test_winkler_without_gross_mm"]
        return shown[[*names, *scores, "winkler_ratio_to_paper", "winkler_ratio_to_paper_without_gross"]]

    def interval_means(self) -> pd.DataFrame:
        """Scores of all intervals at the level, averaged over the moving coordinates."""
        metrics = self.at_level("interval_metrics")
        return metrics[metrics["coordinate"] == "mean_informative"]

    def papers_intervals(self) -> pd.DataFrame:
        """Coverage and Winkler score (mm) of the paper's methods around its model, by dataset and subset."""
        means = self.interval_means()
        papers = means[(means["model"] == "gb") & (means["preset"] == PAPER)]
        papers = papers[papers["interval_method"].isin(PAPERS_METHODS)]
        return papers.set_index(["dataset", "subset", "interval_method"])[["coverage", "winkler_mm"]]

    def gaussian_process_intervals(self) -> pd.DataFrame:
        """Coverage of the tuned Gaussian process' own intervals, by dataset and subset."""
        means = self.interval_means()
        of_process = means[(means["model"] == "gp") & (means["preset"] == TUNED)]
        of_process = of_process[of_process["interval_method"] == "gaussian"]
        return of_process.set_index(["dataset", "subset", "interval_method"])[["coverage"]]

    def joint_coverage(self) -> pd.DataFrame:
        """Of the deployed runs, on `test`: the share of poses held as a whole, by method, and the size."""
        metrics = self.at_level("interval_metrics")
        jointly = metrics[(metrics["coordinate"] == "joint") & (metrics["subset"] == TEST)]
        deployed = self.deployed()[RUN]
        return deployed.merge(jointly)[["dataset", "interval_method", "coverage", "size_mm"]]

    def alarms(self) -> pd.DataFrame:
        """Of the deployed runs, on `test`: the share of poses whose p-value raises an alarm, and the exact band."""
        alarms = self.read("alarm_rates").merge(self.deployed()[RUN])
        at_alpha = alarms["alpha"].round(6) == round(1 - self.level, 6)
        columns = ["dataset", "displacement_mm", "n_rows", "joint_alarm_rate", "joint_low", "joint_high"]
        return alarms.loc[at_alpha & (alarms["subset"] == TEST), columns]
