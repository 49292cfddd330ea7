"""Rule track: result files of one dataset -> MLflow."""

from softkin.files import write_json
from softkin.job import job
from softkin.tracking import Campaign, log_dataset, log_intervals

given = snakemake.input
runs = {
    tuple(run): {"predictions": predictions, "fit": fit}
    for run, predictions, fit in zip(snakemake.params.runs, given.predictions, given.fit, strict=True)
}
for run, parameters, trials in zip(snakemake.params.tuned, given.parameters, given.trials, strict=True):
    runs[tuple(run)] |= {"parameters": parameters, "trials": trials}

with job(snakemake.log[0], f"track {snakemake.wildcards.dataset}"):
    campaign = Campaign(
        name=snakemake.params.campaign,
        seed=snakemake.params.seed,
        tracking_uri=snakemake.params.tracking_uri,
        artifacts="mlartifacts",
    )
    logged = log_dataset(
        campaign, description=given.description, data_card=given.data_card, point=given.point, runs=runs
    )
    dataset = snakemake.wildcards.dataset
    n_intervals = log_intervals(
        campaign, dataset=dataset, metrics=given.intervals, figures=given.figures, parents=logged
    )
    write_json(snakemake.output[0], {"runs": logged, "interval_runs": n_intervals})
