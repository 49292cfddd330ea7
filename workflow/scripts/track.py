"""Rule track: result files of one dataset -> MLflow."""

from softkin.files import write_json
from softkin.job import job
from softkin.tracking import Campaign, log_champion, log_dataset, log_intervals

given = snakemake.input
runs = {
    tuple(run): {"model": model, "predictions": predictions, "fit": fit}
    for run, model, predictions, fit in zip(
        snakemake.params.runs, given.models, given.predictions, given.fit, strict=True
    )
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
    about = {"description": given.description, "data_card": given.data_card}
    logged = log_dataset(campaign, **about, point=given.point, figures=given.figures, runs=runs)
    n_intervals = log_intervals(campaign, **about, metrics=given.intervals, figures=given.figures, parents=logged)
    version = log_champion(
        campaign,
        **about,
        point=given.point,
        intervals=given.intervals,
        calibrated_model=given.calibrated_model,
        parent=logged["campaign"],
    )
    write_json(snakemake.output[0], {"runs": logged, "interval_runs": n_intervals, "champion": version})
