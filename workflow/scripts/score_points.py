"""Rule score_points: predictions -> point metrics of one dataset."""

from softkin.core.job import job
from softkin.core.runs import Run
from softkin.evaluation.score_points import score, score_spaces

dataset, files, params = snakemake.wildcards.dataset, snakemake.input, snakemake.params
of_runs = zip(params.runs, files.predictions, files.fit, files.predict, strict=True)
with job(snakemake.log[0], f"score points {dataset}"):
    score(
        files.table,
        dataset=dataset,
        runs={
            Run(*run): {"predictions": predictions, "fit": fit, "predict": predict}
            for run, predictions, fit, predict in of_runs
        },
        point=snakemake.output.point,
        markers=snakemake.output.markers,
    )
    score_spaces(
        files.table,
        dataset=dataset,
        parameters=dict(zip(params.models, files.parameters, strict=True)),
        chosen=dict(zip(params.models, files.chosen, strict=True)),
        others=next(iter(files.other_spaces), None),
        output=snakemake.output.spaces,
    )
