# The files of softkin that decide a rule's result, as inputs: Snakemake does not see imports. All are read off the
# imports, see src/softkin/core/imported_code.py; the registries' entries that a wildcard or the configuration names are
# inputs of their own.
from softkin.core.imported_code import file_of, imported_code


def code_of(script):
    """What the script of that name imports, but for the entries of registries."""
    return imported_code(
        Path(workflow.basedir) / "workflow" / "scripts" / f"{script}.py"
    )


def entry_code(*functions):
    """The files that define these functions, partial ones too, of registry entries, with what they import."""
    names = {getattr(function, "func", function).__module__ for function in functions}
    return imported_code(*(file_of(name) for name in names))


def model_code(wildcards):
    """What defines one model."""
    return entry_code(MODELS[wildcards.model].build)


def quantile_code(wildcards):
    """What defines one quantile regressor."""
    return entry_code(QUANTILE_MODELS[wildcards.quantile_model].build)


def reader_code(wildcards):
    """What decides how a dataset's file is read."""
    return entry_code(READERS[source(wildcards)["format"]])


def cleaning_code(wildcards):
    """What decides which rows of train are dropped, where the dataset's entry asks for it."""
    cleaning = file_of("softkin.data.audit.cleaning")
    return imported_code(cleaning) if source(wildcards).get("clean") else []


def interval_code():
    """What defines the configured interval methods."""
    methods = [INTERVAL_METHODS[name] for name in config["interval_methods"]]
    return entry_code(*(method.intervals for method in methods))


def region_code():
    """What defines the configured regions."""
    return entry_code(*(REGION_METHODS[name].region for name in config["regions"]))


def page_templates():
    """What the report is rendered with besides modules."""
    folder = file_of("softkin.reporting.page").parent / "templates"
    return sorted(path for path in folder.rglob("*") if path.is_file())
