# The configuration, checked; the lists that it spans; the paths that more than one stage needs.
import sys

from snakemake.exceptions import WorkflowError

import softkin
from softkin.configuration import check_configuration
from softkin.datasets import READERS, reader_files
from softkin.interface import PAPER, PRESETS, SoftkinError, TUNED
from softkin.intervals import INTERVAL_METHODS
from softkin.models import MODELS, source_files
from softkin.quantile_models import QUANTILE_MODELS

try:
    check_configuration(
        config,
        Path(workflow.basedir) / "workflow" / "schemas" / "config.schema.yaml",
        {
            "models": MODELS,
            "formats": READERS,
            "interval_methods": INTERVAL_METHODS,
            "quantile_models": QUANTILE_MODELS,
        },
    )
except SoftkinError as error:
    raise WorkflowError(str(error)) from None

PACKAGE = Path(softkin.__file__).parent
PUBLISHED = Path(workflow.basedir) / "config" / "published"
# For `--software-deployment-method conda`; unused otherwise.
SOFTWARE = "../envs/softkin.yaml"
HEADLINE = "results/tables/headline.txt"
TABLES = [
    "point_metrics.csv",
    "marker_errors.csv",
    "interval_metrics.csv",
    "published_comparison.csv",
    "published_intervals.csv",
    *(["published_columns.csv", "selection.csv"] if TUNED in config["presets"] else []),
]


wildcard_constraints:
    dataset="|".join(config["sources"]),
    model="|".join(MODELS),
    preset="|".join(PRESETS),
    interval_method="|".join(INTERVAL_METHODS),
    quantile_model="|".join(QUANTILE_MODELS),


def package(*modules):
    """Modules of softkin that decide a rule's result: Snakemake does not see imports, it sees inputs."""
    return [PACKAGE / module for module in modules]


def model_code(wildcards):
    """The files that define one model."""
    return source_files(wildcards.model)


def source(wildcards):
    """The dataset's entry in config/datasets.yaml."""
    return config["sources"][wildcards.dataset]


def own_file(wildcards):
    """The file of one's own that an entry without `urls` names: retrieved again when it changes."""
    entry = source(wildcards)
    return [] if "urls" in entry else [entry["file"]]


def reader_code(wildcards):
    """The files that decide how a dataset's file is read."""
    return reader_files(source(wildcards)["format"])


def every_run():
    """[model, preset] of each run that one dataset gets."""
    return [
        [model, preset] for model in config["models"] for preset in config["presets"]
    ]


def run_files(name, presets=tuple(PRESETS)):
    """One file of each run of a dataset, in the order of `every_run`."""
    return [
        f"results/{{dataset}}/{model}/{preset}/{name}"
        for model, preset in every_run()
        if preset in presets
    ]


def interval_runs(interval_method):
    """[model, preset] of each model that an interval method is put around."""
    on_quantiles = [[name, PAPER] for name in config["quantile_models"]]
    return {"predictions": every_run(), "quantiles": on_quantiles}[
        INTERVAL_METHODS[interval_method].on
    ]


def interval_sources(wildcards):
    """The files an interval method starts from, in the order of `interval_runs`."""
    pattern = {
        "predictions": "results/{dataset}/{model}/{preset}/predictions.parquet",
        "quantiles": "results/{dataset}/quantiles/{model}/{preset}/quantiles.parquet",
    }[INTERVAL_METHODS[wildcards.interval_method].on]
    return [
        pattern.format(dataset=wildcards.dataset, model=model, preset=preset)
        for model, preset in interval_runs(wildcards.interval_method)
    ]


def interval_runs_of(wildcards):
    """`interval_runs` of the wildcard's method."""
    return interval_runs(wildcards.interval_method)


def interval_code(wildcards):
    """The file that defines one interval method."""
    return Path(
        sys.modules[
            INTERVAL_METHODS[wildcards.interval_method].intervals.__module__
        ].__file__
    )


def quantile_code(wildcards):
    """The file that defines one learner of quantiles."""
    return Path(
        sys.modules[QUANTILE_MODELS[wildcards.quantile_model].build.__module__].__file__
    )


def of_every_dataset(patterns):
    """The files of the first dataset, then those of the second, ...: the order of `every_dataset_and_model`."""
    return [
        path
        for dataset in config["datasets"]
        for path in expand(patterns, dataset=dataset)
    ]


def every_dataset_and_model():
    """[dataset, model] of each study."""
    return [
        [dataset, model] for dataset in config["datasets"] for model in config["models"]
    ]


def final_output():
    """All that a complete campaign leaves."""
    return [
        HEADLINE,
        "results/tables/paper_tables.md",
        "results/tables/paper_tables.tex",
        *(f"results/tables/{name}" for name in TABLES),
        *expand("results/{dataset}/mlflow_runs.json", dataset=config["datasets"]),
    ]
