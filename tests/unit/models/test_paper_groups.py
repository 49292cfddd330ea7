from __future__ import annotations

import pandas as pd

from softkin.models import MODELS
from softkin.models.paper_groups import ALL, CATEGORIES
from tests.conftest import HOUSE


def test_categories_hold_the_eight_models_of_the_papers_table() -> None:
    grades = pd.read_csv(HOUSE / "resources" / "published" / "approaches.csv")
    assert sorted(ALL) == sorted(grades["model"])
    assert set(ALL) <= set(MODELS)
    for category, models in CATEGORIES.items():
        for model in models:
            assert MODELS[model].family.endswith(category), model
