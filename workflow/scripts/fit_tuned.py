"""Rule fit_tuned: fit a model with the best parameters of each searched preset, on all rows of train."""

from softkin.core.files import read_json
from softkin.core.job import job
from softkin.models import MODELS
from softkin.training.fit import fit
from softkin.training.kinematic_model import FitSettings

dataset, model = snakemake.wildcards.dataset, snakemake.wildcards.model
of_presets = zip(snakemake.input.parameters, snakemake.output.models, snakemake.output.records, strict=True)
with job(snakemake.log[0], f"fit {dataset} {model} tuned"):
    for parameters, fitted, record in of_presets:
        best = read_json(parameters)
        fit(
            snakemake.input.table,
            spec=MODELS[model],
            settings=FitSettings(
                params=best["params"],
                skip_constant=True,
                seed=snakemake.params.seed,
                threads=snakemake.threads,
                target_space=best["target_space"],
                base=snakemake.params.robot["base"],
            ),
            model=fitted,
            record=record,
            max_rows=snakemake.params.max_rows,
        )
