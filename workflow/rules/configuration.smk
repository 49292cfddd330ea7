# The configuration, checked; where data come from, and where the store is.
import os
import sys

from snakemake.exceptions import WorkflowError

from softkin.core.configuration import check_configuration
from softkin.core.errors import SoftkinError
from softkin.data.readers import READERS
from softkin.data.reachability import warning, with_stand_ins
from softkin.data.split import has_standardised_norm
from softkin.data.standins import STANDINS
from softkin.models import MODELS
from softkin.models.quantile import QUANTILE_MODELS
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.regions import REGION_METHODS

# A job has one core. OpenMP and BLAS would take all of them, and two such jobs side by side wait for each other most of
# the time.
os.environ.update(OMP_NUM_THREADS="1")

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

# For `--software-deployment-method conda`; unused otherwise.
SOFTWARE = "../envs/softkin.yaml"


def source(wildcards):
    """The dataset's entry in config/datasets.yaml."""
    return config["sources"][wildcards.dataset]


def own_file(wildcards):
    """The local file that an entry without `urls` names: retrieved again when it changes."""
    entry = source(wildcards)
    return [] if "urls" in entry or "robot" in entry else [entry["file"]]


def robot(wildcards):
    """The params of studies and fits on a robot: its base, and whether command norms are standardised."""
    entry = source(wildcards)
    return {
        "base": entry.get("base"),
        "standardised_norm": has_standardised_norm(entry),
    }


def max_fit_rows(wildcards):
    """How many rows of train a model is fitted on at most; None for one that takes any number."""
    return config["max_fit_rows"].get(wildcards.model)


def tracking_uri():
    """Where the MLflow store is: MLFLOW_TRACKING_URI goes before the configuration."""
    return os.environ.get("MLFLOW_TRACKING_URI") or config["tracking_uri"]


def warn_of_stand_ins():
    """Print which datasets are stand-ins, in colour on a terminal: nobody may take a simulated robot for the real one."""
    if STANDING_IN:
        text = warning(STANDING_IN)
        is_terminal = sys.stderr.isatty()
        print(
            f"\033[1;33m{text}\033[0m" if is_terminal else text,
            file=sys.stderr,
            flush=True,
        )
