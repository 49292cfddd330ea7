from __future__ import annotations

import pandas as pd

from softkin.reporting.tables.orientation import orientation_sentences


def test_a_dataset_with_an_orientation_has_a_sentence() -> None:
    rows = [("arm", "test", 1.25, 0.9, 3.0, 0.91), ("arm", "extrapolation", 2.5, 0.9, 3.0, 0.5)]
    rows += [("arm", subset, mean, 0.5, 1.0, 0.4) for _, subset, mean, *_ in rows]
    columns = ["dataset", "subset", "mean_deg", "confidence_level", "bound_deg", "coverage"]
    said = orientation_sentences(pd.DataFrame(rows, columns=columns))
    assert said == ["arm, orientation: 1.25 degrees off on test, 2.50 beyond; 91.0 % within 3.00 (90 %)."]
    assert orientation_sentences(None) == []
