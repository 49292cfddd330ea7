"""One style for all figures."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from softkin.models import MODELS
from softkin.models.quantile import QUANTILE_MODELS
from softkin.reporting.figures.spec import DatasetResults
from softkin.reporting.figures.style import LOOKS, MODEL_COLOURS, heading, logarithmic, model_samples, panels


def test_every_model_and_quantile_regressor_has_a_look_of_its_own() -> None:
    assert set(LOOKS) >= {*MODELS, *QUANTILE_MODELS}
    assert len(set(LOOKS.values())) == len(LOOKS)
    assert list(LOOKS)[: len(MODELS)] == list(MODELS)


def test_colours_of_models_can_be_told_apart_without_red_or_green() -> None:
    """Vienot et al. (1999): colours as seen without red (protan) or green cones (deutan)."""
    from matplotlib.colors import to_rgb

    seen_as = {
        "protan": [[0.11238, 0.88762, 0.0], [0.11238, 0.88762, 0.0], [0.00401, -0.00401, 1.0]],
        "deutan": [[0.29275, 0.70725, 0.0], [0.29275, 0.70725, 0.0], [-0.02234, 0.02234, 1.0]],
    }
    linear = np.array([to_rgb(colour) for colour in MODEL_COLOURS]) ** 2.2
    for matrix in seen_as.values():
        seen = np.clip(linear @ np.array(matrix).T, 0, 1) ** (1 / 2.2)
        apart = [np.linalg.norm(a - b) for a, b in itertools.combinations(seen, 2)]
        assert min(apart) > 0.1  # matplotlib's own ten fail


@pytest.mark.parametrize(("values", "shown"), [([1.2, 7.0], {"2", "5"}), ([1e-7, 1.0], {"$\\mathdefault{10^{-5}}$"})])
def test_logarithmic_axes_have_numbers(values: list[float], shown: set[str]) -> None:
    figure, [[axes]] = panels(1, 1, 7.0, 3.0)
    axes.loglog(values, values)
    logarithmic(axes.yaxis)
    figure.draw_without_rendering()
    labels = {label.get_text() for label in axes.get_yticklabels()}
    assert shown <= labels
    assert len(labels) <= 12


def test_the_heading_has_the_notes_of_the_subsets_that_are_shown(results: DatasetResults) -> None:
    figure, _ = panels(1, 1, 7.0, 3.0)
    heading(figure, results, "a title")
    assert figure.get_suptitle() == "ARM: a title\ntest: made up"
    heading(figure, results, "a title", ["train"])
    assert figure.get_suptitle() == "ARM: a title"


def test_models_have_their_look_and_title_in_the_legend(results: DatasetResults) -> None:
    [entry] = model_samples(["gp"], results)
    assert (entry.get_label(), entry.get_color(), entry.get_marker()) == ("Gaussian process", *LOOKS["gp"])
