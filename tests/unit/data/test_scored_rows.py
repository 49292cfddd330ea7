from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from softkin.core.samples import EXTRAPOLATION, SUBSETS, TEST, TRAIN, VALIDATION
from softkin.data.scored_rows import ALL_ROWS, KeptRows, drawn_rows, scored_rows
from tests.conftest import HOUSE, four_subsets


def test_rows_are_drawn_of_what_is_scored_and_never_of_train(caplog: pytest.LogCaptureFixture) -> None:
    samples = four_subsets({TRAIN: 40, VALIDATION: 12, TEST: 9, EXTRAPOLATION: 10}, n_commands=2, n_markers=1)
    kept, drawn_from = scored_rows(samples, KeptRows(scored=10))
    assert {subset: len(rows) for subset, rows in kept.items()} == {
        TRAIN: 40,
        VALIDATION: 10,
        TEST: 9,
        EXTRAPOLATION: 10,
    }
    assert drawn_from == {VALIDATION: 12}
    assert "10 of 12 rows of validation are kept: max_scored_rows" in caplog.text
    places = [samples[VALIDATION].commands.tolist().index(row) for row in kept[VALIDATION].commands.tolist()]
    assert places == sorted(set(places))  # in their order, none twice
    np.testing.assert_array_equal(kept[VALIDATION].positions, samples[VALIDATION].positions[places])


def test_as_many_rows_as_published_robots_have_stay_as_they_are() -> None:
    at_most = next(
        int(line.split(":")[1])
        for line in (HOUSE / "config" / "config.yaml").read_text().splitlines()
        if line.startswith("max_scored_rows:")
    )
    sizes = dict.fromkeys(SUBSETS, 3_160)
    samples = four_subsets(sizes, n_commands=1, n_markers=1)
    kept, drawn_from = scored_rows(samples, KeptRows(scored=at_most))
    assert all(kept[subset] is samples[subset] for subset in SUBSETS)
    assert drawn_from == {}
    assert all(a is b for a, b in zip(scored_rows(samples, ALL_ROWS)[0].values(), samples.values(), strict=True))


def test_the_draw_follows_the_seed_and_keeps_a_row_of_each_block() -> None:
    block = np.repeat([3, 1, 7, 5], [500, 1, 2, 97])
    drawn = [drawn_rows(600, block, 20, seed) for seed in range(50)]
    assert all(set(block[rows]) == {1, 3, 5, 7} for rows in drawn)
    assert all(len(set(rows)) == 20 and (np.diff(rows) > 0).all() for rows in drawn)
    np.testing.assert_array_equal(drawn[0], drawn_rows(600, block, 20, 0))
    assert not np.array_equal(drawn[0], drawn[1])
    # Beyond the first row of a block all rows are drawn alike: 16 of the 596 others.
    in_large = np.mean([(block[rows] == 3).sum() - 1 for rows in drawn])
    assert in_large == pytest.approx(16 * 499 / 596, abs=1.0)


def test_of_more_blocks_than_rows_some_blocks_are_drawn() -> None:
    block = np.arange(200) // 2
    rows = drawn_rows(200, block, 30, 0)
    assert len(set(block[rows])) == 30


def test_blocks_and_recordings_go_with_their_rows() -> None:
    samples = four_subsets(dict.fromkeys(SUBSETS, 8), n_commands=1, n_markers=1)
    samples = {subset: replace(rows, block=np.arange(8)) for subset, rows in samples.items()}
    kept, _ = scored_rows(samples, KeptRows(scored=5))
    block = kept[TEST].block
    assert block is not None
    np.testing.assert_array_equal(kept[TEST].commands, samples[TEST].commands[block])
