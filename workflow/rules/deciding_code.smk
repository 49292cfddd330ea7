# The files of softkin that decide a rule's result: Snakemake does not see imports, it sees inputs.
def package(*modules):
    """Modules of softkin that decide a rule's result: Snakemake does not see imports, it sees inputs."""
    return [PACKAGE / module for module in modules]


def model_code(wildcards):
    """The files that define one model."""
    return source_files(wildcards.model)


# What decides how a model is fitted and predicts, besides its own file.
FITTING_CODE = [
    "fitting.py",
    "estimators/position_scaler.py",
    "estimators/kinematic_regressor.py",
    "target_spaces/cartesian.py",
    "target_spaces/curvature.py",
    "target_spaces/constant_curvature.py",
    "target_spaces/base_frame.py",
    "rows.py",
    "smooth_fit.py",
    "datasets/table.py",
]


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


# All figures of a dataset are one job. Not imported: their libraries would be, every time Snakemake starts.
FIGURE_CODE = sorted((PACKAGE / "figures").glob("*.py"))


# What decides how stored outputs become what a method sees.
EVIDENCE_CODE = [
    "evidence.py",
    "bounds.py",
    "conformal.py",
    "growth.py",
    "shells.py",
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
