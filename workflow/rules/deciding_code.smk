# The code that decides a rule's result, as a param `code`: Snakemake does not see imports. A hash of the script and of all
# that it imports, read off the imports, see src/softkin/core/imported_code.py; to it come the registries' entries that a
# wildcard or the configuration names. A hash of contents knows neither the folder that softkin is in nor the times of its
# files, and is one string where the files would be sixty inputs of each job.
from functools import cache

from softkin.core.files import sha256_of
from softkin.core.imported_code import code_hash, file_of


@cache
def code_of(script, *modules):
    """The code of the script of that name and of modules, entries of registries."""
    scripts = Path(workflow.basedir) / "workflow" / "scripts"
    return code_hash(scripts / f"{script}.py", *map(file_of, modules))


@cache
def code_of_study(module, entry):
    """The code that decides a study: the module that tunes, and the entry of a registry that is tuned."""
    return code_hash(file_of(module), file_of(entry))


def module_of(function):
    """The name of the module that defines a function, a partial one too."""
    return getattr(function, "func", function).__module__


def prepare_code(wildcards):
    """The code that reads a dataset's file, and that which cleans its rows, where its entry asks for it."""
    entry = source(wildcards)
    cleaning = ["softkin.data.audit.cleaning"] if entry.get("clean") else []
    return code_of("prepare", module_of(READERS[entry["format"]]), *cleaning)


def model_code(wildcards):
    """The code that tunes, fits and predicts with one model."""
    return code_of("fit_model", module_of(MODELS[wildcards.model].build))


def study_code(wildcards):
    """The code that decides the studies of one model."""
    return code_of_study(
        "softkin.training.tune", module_of(MODELS[wildcards.model].build)
    )


def ensemble_code(wildcards):
    """The code that weights runs, and predicts with their mean."""
    return code_of("fit_ensemble", module_of(ENSEMBLES[wildcards.ensemble].steps))


def quantile_code(wildcards):
    """The code that tunes, fits and predicts with one quantile regressor."""
    return code_of(
        "fit_quantiles", module_of(QUANTILE_MODELS[wildcards.quantile_model].build)
    )


def quantile_study_code(wildcards):
    """The code that decides the study of one quantile regressor."""
    return code_of_study(
        "softkin.training.tune_quantiles",
        module_of(QUANTILE_MODELS[wildcards.quantile_model].build),
    )


def interval_modules(methods):
    """What defines these interval methods."""
    return [module_of(INTERVAL_METHODS[name].intervals) for name in methods]


def region_modules():
    """What defines the configured regions."""
    return [module_of(REGION_METHODS[name].region) for name in config["regions"]]


def content(pattern):
    """Hash of the files of the repository that match a pattern: read by a script, and neither code nor results."""
    return sha256_of(sorted(Path(workflow.basedir).glob(pattern)))
