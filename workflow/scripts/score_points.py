"""Rule score_points: predictions -> point metrics of one dataset."""

from softkin.core.job import job
from softkin.core.runs import Run
from softkin.evaluation.score_points import score, score_spaces

dataset = snakemake.wildcards.dataset
files = zip(snakemake.input.predictions, snakemake.input.fit, snakemake.input.predict, strict=True)
with job(snakemake.log[0], f"score points {dataset}"):
    score(
        snakemake.input.table,
        dataset=dataset,
        runs={
            Run(*run): {"predictions": predictions, "fit": fit, "predict": predict}
            for run, (predictions, fit, predict) in zip(snakemake.params.runs, files, strict=True)
        },
        point=snakemake.output.point,
        markers=snakemake.output.markers,
    )
    score_spaces(
        snakemake.input.table,
        dataset=dataset,
        parameters=dict(zip(snakemake.params.models, snakemake.input.parameters, strict=True)),
        chosen=dict(zip(snakemake.params.models, snakemake.input.chosen, strict=True)),
        others=next(iter(snakemake.input.other_spaces), None),
        output=snakemake.output.spaces,
    )
