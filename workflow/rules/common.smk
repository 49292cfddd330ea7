# The configuration, checked; the lists that it spans; the paths that more than one stage needs.
import os
import sys

from snakemake.exceptions import WorkflowError

import softkin
from softkin.configuration import check_configuration
from softkin.datasets import READERS, reader_files
from softkin.datasets.reaching import warning, with_stand_ins
from softkin.interface import PAPER, PRESETS, SoftkinError, TUNED
from softkin.intervals import INTERVAL_METHODS
from softkin.models import MODELS, source_files
from softkin.quantile_models import QUANTILE_MODELS
from softkin.regions import REGION_METHODS
from softkin.standins import STANDINS

try:
    check_configuration(
        config,
        Path(workflow.basedir) / "workflow" / "schemas" / "config.schema.yaml",
        {
            "models": MODELS,
            "formats": READERS,
            "interval_methods": INTERVAL_METHODS,
            "quantile_models": QUANTILE_MODELS,
            "regions": REGION_METHODS,
            "standins": STANDINS,
        },
    )
except SoftkinError as error:
    raise WorkflowError(str(error)) from None

STANDING_IN = []
if config["when_unreachable"] == "simulate":
    config["datasets"], config["sources"], STANDING_IN = with_stand_ins(
        config["datasets"],
        config["sources"],
        mirror=os.environ.get("SOFTKIN_DATA_MIRROR") or config.get("data_mirror"),
        retrieved={name: Path(f"results/{name}/raw") for name in config["datasets"]},
    )

PACKAGE = Path(softkin.__file__).parent
PUBLISHED = Path(workflow.basedir) / "config" / "published"
# For `--software-deployment-method conda`; unused otherwise.
SOFTWARE = "../envs/softkin.yaml"
HEADLINE = "results/tables/headline.txt"
REPORT = "results/report.html"
TABLES = [
    "point_metrics.csv",
    "marker_errors.csv",
    "interval_metrics.csv",
    "interval_choice.csv",
    "conditional_coverage.csv",
    "alarm_rates.csv",
    "published_comparison.csv",
    "published_intervals.csv",
    *(["published_columns.csv", "selection.csv"] if TUNED in config["presets"] else []),
]


wildcard_constraints:
    dataset="|".join(config["sources"]),
    model="|".join(MODELS),
    preset="|".join(PRESETS),
    quantile_model="|".join(QUANTILE_MODELS),


def package(*modules):
    """Modules of softkin that decide a rule's result: Snakemake does not see imports, it sees inputs."""
    return [PACKAGE / module for module in modules]


def model_code(wildcards):
    """The files that define one model."""
    return source_files(wildcards.model)


def max_fit_rows(wildcards):
    """How many rows of train a model is fitted on at most; None for one that takes any number."""
    return config["max_fit_rows"].get(wildcards.model)


def source(wildcards):
    """The dataset's entry in config/datasets.yaml."""
    return config["sources"][wildcards.dataset]


def own_file(wildcards):
    """The file of one's own that an entry without `urls` names: retrieved again when it changes."""
    entry = source(wildcards)
    return [] if "urls" in entry or "robot" in entry else [entry["file"]]


def reader_code(wildcards):
    """The files that decide how a dataset's file is read."""
    return reader_files(source(wildcards)["format"])


def cleaning_code(wildcards):
    """The files that decide which rows of train are dropped, where the entry asks for it."""
    names = ("cleaning", "duplicate_rows", "stuck_poses")
    return (
        package(
            "findings.py",
            "rows.py",
            "smooth_fit.py",
            *(f"auditing/{name}.py" for name in names),
        )
        if source(wildcards).get("clean")
        else []
    )


def warn_of_stand_ins():
    """In colour, where there is a terminal to show it: nobody may take a simulated robot for the real thing."""
    if STANDING_IN:
        text = warning(STANDING_IN)
        is_terminal = sys.stderr.isatty()
        print(
            f"\033[1;33m{text}\033[0m" if is_terminal else text,
            file=sys.stderr,
            flush=True,
        )


def every_run(models=tuple(config["models"])):
    """[model, preset] of each run that one dataset gets."""
    return [[model, preset] for model in models for preset in config["presets"]]


def run_files(name, presets=tuple(PRESETS), models=tuple(config["models"])):
    """One file of each run of a dataset, in the order of `every_run`."""
    return [
        f"results/{{dataset}}/{model}/{preset}/{name}"
        for model, preset in every_run(models)
        if preset in presets
    ]


# The models that CV+ and jackknife+-after-bootstrap refit, if any of these methods is asked for.
CHEAP_MODELS = [name for name in config["models"] if MODELS[name].is_cheap]
QUANTILE_RUNS = [
    [name, preset] for name in config["quantile_models"] for preset in config["presets"]
]


def asks_for(*kinds):
    """Whether a configured interval method starts from one of these kinds of stored outputs."""
    return any(
        INTERVAL_METHODS[name].on in kinds for name in config["interval_methods"]
    )


def stored_outputs(wildcards):
    """Everything that the interval methods start from, of one dataset."""
    quantiles = "results/{{dataset}}/quantiles/{0}/{1}/quantiles.parquet"
    patterns = {
        "predictions": run_files("predictions.parquet"),
        "quantiles": [
            quantiles.format(*run) for run in QUANTILE_RUNS if asks_for("quantiles")
        ],
        "refits": ["results/{dataset}/refits.npz"] * asks_for("folds", "resamples"),
    }
    return {
        name: expand(paths, dataset=wildcards.dataset)
        for name, paths in patterns.items()
    }


def interval_params():
    """What the interval rules are told."""
    return {
        "methods": config["interval_methods"],
        "runs": every_run(),
        "quantile_runs": QUANTILE_RUNS if asks_for("quantiles") else [],
        "confidence_levels": config["confidence_levels"],
        "seed": config["seed"],
    }


# All figures of a dataset are one job. Not imported: their libraries would be, every time Snakemake starts.
FIGURE_CODE = sorted((PACKAGE / "figures").glob("*.py"))
# What decides how stored outputs become what a method sees.
EVIDENCE_CODE = [
    "evidence.py",
    "bounds.py",
    "conformal.py",
    "datasets/table.py",
    "estimators/column.py",
    "estimators/refitted.py",
]


def files_of(functions):
    """The files that define these functions."""
    names = {getattr(function, "func", function).__module__ for function in functions}
    return [Path(sys.modules[name].__file__) for name in sorted(names)]


def interval_code():
    """The files that define the configured interval methods."""
    return files_of(
        INTERVAL_METHODS[name].intervals for name in config["interval_methods"]
    )


def region_code():
    """The files that define the configured regions."""
    return files_of(REGION_METHODS[name].region for name in config["regions"])


def quantile_code(wildcards):
    """The file that defines one learner of quantiles."""
    return files_of([QUANTILE_MODELS[wildcards.quantile_model].build])


def quantile_parameters(wildcards):
    """For the tuned preset, what its study found."""
    path = "results/{dataset}/quantiles/{quantile_model}/tuned/parameters.json"
    return expand(path, **wildcards) if wildcards.preset == TUNED else []


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
        REPORT,
        HEADLINE,
        "results/tables/paper_tables.md",
        "results/tables/paper_tables.tex",
        "results/tables/figures",
        *(f"results/tables/{name}" for name in TABLES),
        *expand(
            "results/{dataset}/{name}",
            dataset=config["datasets"],
            name=["data_card.md", "figures", "calibrated_model.joblib"],
        ),
        *expand("results/{dataset}/mlflow_runs.json", dataset=config["datasets"]),
    ]
