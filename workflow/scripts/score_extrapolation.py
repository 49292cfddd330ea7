"""Rule score_extrapolation: intervals in extrapolation, each beside the oracle, of one dataset."""

from softkin.core.job import job
from softkin.core.runs import Run
from softkin.evaluation.score_extrapolation import ExtrapolationMethods, score_extrapolation
from softkin.training.selection import shell_runs
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.labelled import LABELLED_METHODS

dataset, files, params = snakemake.wildcards.dataset, snakemake.input, snakemake.params
runs = [Run(*run) for run in params.runs]
parameters = dict(zip([Run(*run) for run in params.searched], files.parameters, strict=True))
with job(snakemake.log[0], f"score extrapolation {dataset}"):
    score_extrapolation(
        files.table,
        dataset=dataset,
        standardised_norm=params.robot["standardised_norm"],
        methods=ExtrapolationMethods(
            methods={name: INTERVAL_METHODS[name] for name in params.methods},
            intervals=dict(zip(params.methods, files.intervals, strict=True)),
            labelled=LABELLED_METHODS,
            confidence_levels=params.confidence_levels,
            seed=params.seed,
        ),
        predictions=dict(zip(runs, files.predictions, strict=True)),
        runs=shell_runs(runs, parameters, params.objective, params.robust_models),
        output=snakemake.output[0],
    )
