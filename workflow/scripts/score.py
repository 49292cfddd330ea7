"""Rule score: predictions and intervals of one dataset beside the truth."""

from softkin.core.job import job
from softkin.core.job_records import load_model
from softkin.core.manifest import files_of, files_of_runs
from softkin.core.runs import OUTER, Run
from softkin.core.samples import SUBSETS
from softkin.data.table import read_subset
from softkin.evaluation.conditional_coverage import conditional_coverage
from softkin.evaluation.score_extrapolation import ExtrapolationMethods, score_extrapolation
from softkin.evaluation.score_intervals import score_intervals
from softkin.evaluation.score_joint import joint_rows
from softkin.evaluation.score_left_out import score_left_out
from softkin.evaluation.score_points import score_points, score_spaces
from softkin.evaluation.score_regions import score_alarms
from softkin.training.selection import shell_runs
from softkin.uncertainty.choose import shown_runs
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.labelled import LABELLED_METHODS
from softkin.uncertainty.promise import promised_methods
from softkin.uncertainty.regions import REGION_METHODS
from softkin.uncertainty.stored_outputs import INTERVAL_SUBSETS, stored_outputs

files, params, output, dataset = snakemake.input, snakemake.params, snakemake.output, snakemake.wildcards.dataset
predictions = files_of_runs(files.models, params.runs, "predictions.parquet")
parameters = files_of_runs(files.models, params.searched, "parameters.json")
methods = {name: INTERVAL_METHODS[name] for name in params.methods}
intervals = files_of(files.intervals, {name: f"{name}.parquet" for name in methods})
# Methods for extrapolation have nothing to show on test.
in_domain = {name: intervals[name] for name in methods if not methods[name].calibrated_on.is_for_extrapolation}


def points():
    """Errors of predictions."""
    score_points(
        files.table,
        dataset=dataset,
        predictions=predictions,
        records=files_of_runs(files.models, params.runs, "fit.json"),
        point=output.point,
        markers=output.markers,
    )
    score_spaces(
        files.table,
        dataset=dataset,
        parameters={model: parameters[Run(model, OUTER)] for model in params.compared},
        chosen={model: predictions[Run(model, OUTER)] for model in params.compared},
        others=next(iter(files.other_spaces), None),
        output=output.spaces,
    )


def coverage():
    """Coverage and scores of intervals and regions, in-domain and in extrapolation."""
    outputs = stored_outputs(files, params)
    robot = next(map(load_model, files.calibrated_model), None)
    subsets = {subset: read_subset(files.table, subset) for subset in INTERVAL_SUBSETS}
    score_intervals(
        files.table,
        dataset=dataset,
        methods=methods,
        intervals=intervals,
        regions={name: REGION_METHODS[name] for name in params.regions},
        outputs=outputs,
        output=output.intervals,
        joint=() if robot is None else joint_rows(robot, subsets, outputs.levels),
    )
    conditional_coverage(
        files.table,
        dataset=dataset,
        intervals=in_domain,
        shown=shown_runs(files.choice),
        confidence_levels=params.confidence_levels,
        seed=params.seed,
        output=output.conditional,
        robot=robot,
    )
    score_left_out(
        files.table,
        dataset=dataset,
        predictions=predictions,
        intervals=in_domain,
        shown=shown_runs(files.choice),
        confidence_levels=params.confidence_levels,
        output=output.left_out,
    )
    samples = {subset: read_subset(files.table, subset) for subset in SUBSETS}
    score_alarms(outputs, samples, dataset=dataset, seed=params.seed, output=output.alarms)
    score_extrapolation(
        files.table,
        dataset=dataset,
        standardised_norm=params.robot["standardised_norm"],
        methods=ExtrapolationMethods(
            methods=promised_methods(methods, outputs.promise),
            intervals=intervals,
            labelled=LABELLED_METHODS,
            confidence_levels=params.confidence_levels,
            seed=params.seed,
        ),
        predictions=predictions,
        runs=shell_runs(list(predictions), parameters, params.objective, params.robust_models),
        output=output.extrapolation,
    )


with job(snakemake.log[0], f"score {dataset}", snakemake.output, snakemake.input, snakemake.params):
    points()
    coverage()
