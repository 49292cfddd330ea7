"""Rule track: result files of one dataset -> MLflow."""

from softkin.core.credentials import with_credentials
from softkin.core.files import write_json
from softkin.core.job import job
from softkin.core.manifest import files_of_runs
from softkin.core.runs import Run
from softkin.tracking.champion import log_champion
from softkin.tracking.intervals import log_intervals
from softkin.tracking.links import link_to
from softkin.tracking.lock import locked
from softkin.tracking.models import log_dataset
from softkin.tracking.orientation import log_orientation
from softkin.tracking.store import Campaign, client_of

files, params = snakemake.input, snakemake.params
tracking_uri = with_credentials(params.tracking_uri)
OF_EVERY_RUN = {"model": "model.joblib", "predictions": "predictions.parquet", "fit": "fit.json"}
OF_SEARCHED_RUNS = {"parameters": "parameters.json", "trials": "trials.csv"}
runs = {Run(*run): {} for run in params.runs}
for wanted, names in ((params.runs, OF_EVERY_RUN), (params.tuned, OF_SEARCHED_RUNS)):
    for kind, name in names.items():
        for run, path in files_of_runs(files.models, wanted, name).items():
            runs[run][kind] = path

with job(snakemake.log[0], f"track {snakemake.wildcards.dataset}", snakemake.output, snakemake.input, snakemake.params):
    campaign = Campaign(
        name=params.campaign,
        seed=params.seed,
        tracking_uri=tracking_uri,
        caution=params.caution,
    )
    with locked(tracking_uri, snakemake.wildcards.dataset):
        of_dataset = {"description": files.description, "data_card": files.data_card}
        logged = log_dataset(campaign, **of_dataset, point=files.point, figures=files.figures, runs=runs)
        n_intervals = log_intervals(
            campaign, **of_dataset, metrics=files.intervals, figures=files.figures, parents=logged
        )
        log_orientation(campaign, **of_dataset, scores=next(iter(files.orientation), None), parent=logged["campaign"])
        version = log_champion(
            campaign,
            **of_dataset,
            point=files.point,
            intervals=files.intervals,
            calibrated_model=files.calibrated_model,
            parent=logged["campaign"],
        )
        link = link_to(client_of(tracking_uri), snakemake.wildcards.dataset)
        of_store = {"runs": logged, "interval_runs": n_intervals, "champion": version, "link": link}
        write_json(snakemake.output[0], of_store)
