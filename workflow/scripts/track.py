"""Rule track: result files of one dataset -> MLflow."""

from softkin.core.files import write_json
from softkin.core.job import job
from softkin.core.runs import Run
from softkin.tracking import Campaign, locked, log_champion, log_dataset, log_intervals

files, params = snakemake.input, snakemake.params
runs = {
    Run(*run): {"model": model, "predictions": predictions, "fit": fit}
    for run, model, predictions, fit in zip(params.runs, files.models, files.predictions, files.fit, strict=True)
}
for run, parameters, trials in zip(params.tuned, files.parameters, files.trials, strict=True):
    runs[Run(*run)] |= {"parameters": parameters, "trials": trials}

with job(snakemake.log[0], f"track {snakemake.wildcards.dataset}"):
    campaign = Campaign(
        name=params.campaign,
        seed=params.seed,
        tracking_uri=params.tracking_uri,
        caution=params.caution,
    )
    with locked(params.tracking_uri, snakemake.wildcards.dataset):
        of_dataset = {"description": files.description, "data_card": files.data_card}
        logged = log_dataset(campaign, **of_dataset, point=files.point, figures=files.figures, runs=runs)
        n_intervals = log_intervals(
            campaign, **of_dataset, metrics=files.intervals, figures=files.figures, parents=logged
        )
        version = log_champion(
            campaign,
            **of_dataset,
            point=files.point,
            intervals=files.intervals,
            calibrated_model=files.calibrated_model,
            parent=logged["campaign"],
        )
        write_json(snakemake.output[0], {"runs": logged, "interval_runs": n_intervals, "champion": version})
