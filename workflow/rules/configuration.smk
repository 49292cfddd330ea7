# The configuration, checked; where data come from, and where the store is.
import gc
import os
import sys

from snakemake.exceptions import WorkflowError

from softkin.cli.configuration import check
from softkin.core.config_files import check_config_files
from softkin.core.credentials import hide_credentials, with_credentials
from softkin.core.errors import SoftkinError
from softkin.core.fit_rows import rows_of_fit
from softkin.core.narrowing import of_data
from softkin.core.urls import without_credentials
from softkin.data import own_files
from softkin.data.readers import READERS
from softkin.data.reachability import out_of_reach, warning, with_stand_ins
from softkin.data.split import has_standardised_norm
from softkin.data.standins import STANDINS
from softkin.models import MODELS
from softkin.models.ensembles import ENSEMBLES
from softkin.models.quantile import QUANTILE_MODELS
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.regions import REGION_METHODS

# A job has one core. OpenMP and BLAS would take all of them, and two such jobs side by side wait for each other most of
# the time.
os.environ.update(OMP_NUM_THREADS="1")

# What Snakemake builds before its first job is no garbage, and looking for some takes a tenth of a large dry run;
# `start_of_jobs` has it looked for again.
if workflow.is_main_process:
    gc.disable()

# A job on another node starts Snakemake again. What the main process has checked and looked for, it takes as it is told:
# its node may reach neither the internet nor the mirror. The names of the datasets that stand-ins replace are in here.
TOLD = "SOFTKIN_STAND_INS_OF"


def stopping(check, *arguments, **named):
    """Make a check whose error ends the run with its message alone."""
    try:
        check(*arguments, **named)
    except SoftkinError as error:
        raise WorkflowError(str(error)) from None


DEFAULTS = [
    Path(workflow.basedir) / "config" / name
    for name in ("config.yaml", "datasets.yaml")
]
# Before Snakemake reads them: it does not name the line of a mistake.
if workflow.is_main_process:
    stopping(check_config_files, DEFAULTS)


configfile: DEFAULTS[0]
configfile: DEFAULTS[1]


def to_be_replaced():
    """The datasets that cannot be had now, where stand-ins are to take their place, and what their sources answer."""
    if config["when_unreachable"] != "simulate":
        return {}
    mirror = os.environ.get("SOFTKIN_DATA_MIRROR") or config.get("data_mirror")
    return out_of_reach(
        config["datasets"],
        config["sources"],
        mirror=mirror and with_credentials(mirror),
        retrieved={name: Path(f"results/{name}/raw") for name in config["datasets"]},
    )


# Params of jobs are written to files, the configuration among them.
if not workflow.is_main_process:
    hide_credentials(config)

# Why, which the main process alone knows, and alone says.
REPLACED = {}
if workflow.is_main_process:
    stopping(hide_credentials, config)
    stopping(
        check,
        config,
        schema=Path(workflow.basedir) / "workflow" / "schemas" / "config.schema.yaml",
        files=workflow.configfiles,
        environment=os.environ,
    )
    REPLACED = to_be_replaced()
    os.environ[TOLD] = ",".join(REPLACED)


envvars:
    TOLD,


STANDING_IN = [name for name in os.environ[TOLD].split(",") if name]
config["datasets"], config["sources"] = with_stand_ins(
    config["datasets"], config["sources"], STANDING_IN
)

# For `--software-deployment-method conda`; unused otherwise.
SOFTWARE = "../envs/softkin.yaml"


def source(wildcards):
    """What the dataset's entry in config/datasets.yaml says of its data."""
    if wildcards.dataset not in config["sources"]:
        raise WorkflowError(f"{wildcards.dataset} is no entry of config/datasets.yaml")
    return of_data(config["sources"][wildcards.dataset])


def overrides(wildcards):
    """The settings of the paper's model that differ on the dataset."""
    return source(wildcards).get("paper_params", {}).get(wildcards.model, {})


def own_file(wildcards):
    """The local files that an entry without `urls` names: retrieved again when one changes, or another comes."""
    entry = source(wildcards)
    return [] if "urls" in entry or "robot" in entry else own_files.listed(entry)


def order_table(wildcards):
    """The table that says when the rows of a dataset were recorded, where its entry names one: that of a published
    dataset comes with softkin.
    """
    entry = source(wildcards)
    if not isinstance(entry.get("order"), dict):
        return []
    name = entry["order"]["file"]
    folder = Path(workflow.basedir) / "resources" / "published"
    return [str(folder / name) if "urls" in entry else name]


def is_recorded(entry):
    """Whether a dataset's entry says when its rows were recorded; of a stand-in, whether it is recorded in sessions."""
    of_robot = "robot" in entry and bool(STANDINS[entry["robot"]].sessions)
    return of_robot or "order" in entry or "session" in entry


def robot(wildcards):
    """The params of studies and fits on a robot: its base, and whether command norms are standardised."""
    entry = source(wildcards)
    return {
        "base": entry.get("base"),
        "standardised_norm": has_standardised_norm(entry),
    }


def max_fit_rows(wildcards):
    """How many rows of train a model, or the quantile regressor of that name, is fitted on at most; None for any number."""
    names = wildcards.get("model"), wildcards.get("quantile_model")
    return rows_of_fit(config["max_fit_rows"], *names)


def tracking_uri():
    """Where the MLflow store is, as it is shown: MLFLOW_TRACKING_URI goes before the configuration."""
    uri = os.environ.get("MLFLOW_TRACKING_URI") or config["tracking_uri"]
    return without_credentials(uri)


def warn_of_stand_ins():
    """Print which datasets are stand-ins, in colour on a terminal: nobody may take a simulated robot for the real one."""
    if REPLACED:
        text = warning(REPLACED)
        is_terminal = sys.stderr.isatty()
        print(
            f"\033[1;33m{text}\033[0m" if is_terminal else text,
            file=sys.stderr,
            flush=True,
        )
