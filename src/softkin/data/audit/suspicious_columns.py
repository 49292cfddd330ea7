"""Check for columns that are not what a robot's table should hold: each finding names them, and a person decides.

- `suspicious_affine`: an affine map of the commands gives a position, or a difference of two markers is a command: one
  of them is a model's output, or computed from the other.
- `suspicious_orientation`: three or four commands in a row are of unit norm: a direction or a quaternion.
- `suspicious_copies`: a column is another times a constant.
- `suspicious_pairs`: two columns differ by little: the desired and the measured value of one quantity.
- `suspicious_running_number`: a command grows by one step from row to row, as a counter or a clock does.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import combinations

import numpy as np

from softkin.core.rows import sampled_rows, stacked_commands, stacked_positions
from softkin.core.samples import TRAIN, Array, Samples, command_columns, coordinate_columns
from softkin.data.audit.findings import WARNING, CheckResult, Finding

#: What commands give by an affine map to this share of its range is no measurement.
AFFINE = 1e-4
#: Norms this near to 1 in all rows are of unit vectors.
UNIT_NORM = 1e-3
#: Columns that agree to this share of their range are copies. Commands that differ by less than the second share (RMS)
#: are desired and measured values; of a command and a position, in units that need not be the same, the third counts.
COPY, PAIR, PAIR_OF_KINDS = 1e-6, 0.02, 0.005
MAX_ROWS, MAX_COLUMNS, FEWEST_ROWS, ROWS_PER_TERM = 5_000, 64, 20, 3
CONSEQUENCES = {
    "suspicious_affine": "A measured soft robot is never so exact: one of these columns is the output of a model, or a "
    "difference to it. Errors near zero then say nothing of the robot. Leave computed columns out.",
    "suspicious_orientation": "An orientation is measured and not commanded, and has no place among the commands.",
    "suspicious_copies": "The copy adds nothing, or is another frame or unit of the same quantity. Leave one out.",
    "suspicious_pairs": "If one is the desired and one the measured value, keep the one that is known when a pose is "
    "to be predicted.",
    "suspicious_running_number": "Numbers of rows and times are no commands: write the column as `order`.",
}


def check(samples: Mapping[str, Samples], seed: int = 0) -> CheckResult:
    """At most one finding of each kind, on all subsets."""
    commands = stacked_commands(samples)[:, :MAX_COLUMNS]
    n_coordinates = min(samples[TRAIN].positions.shape[1], MAX_COLUMNS // 3 * 3)
    positions = stacked_positions(samples, np.arange(samples[TRAIN].positions.shape[1]) < n_coordinates)
    rows = sampled_rows(len(commands), MAX_ROWS, seed)
    commands, positions = commands[rows], positions[rows]
    numbers = {"rows_looked_at": len(rows)}
    if len(rows) < FEWEST_ROWS:
        return CheckResult((), numbers | {"not_measured": f"fewer than {FEWEST_ROWS} rows"})
    by_code: dict[str, Iterable[str]] = {
        "suspicious_affine": [*_affine(commands, positions), *_differences(commands, positions)],
        "suspicious_orientation": _unit_norms(commands),
        "suspicious_copies": _copies(commands, positions),
        "suspicious_pairs": _pairs(commands, positions),
        "suspicious_running_number": _running(samples),
    }
    found = {code: list(sentences) for code, sentences in by_code.items()}
    findings = [
        Finding(code, WARNING, tuple(samples), "; ".join(sentences) + ".", CONSEQUENCES[code])
        for code, sentences in found.items()
        if sentences
    ]
    return CheckResult(tuple(findings), numbers | {code: len(sentences) for code, sentences in found.items()})


def _affine(commands: Array, positions: Array) -> Iterator[str]:
    if len(commands) < ROWS_PER_TERM * (commands.shape[1] + 1):
        return
    extents = np.ptp(positions, axis=0)
    terms = np.column_stack([np.ones(len(commands)), (commands - commands.mean(axis=0)) / _scale(commands)])
    errors = np.abs(positions - terms @ np.linalg.lstsq(terms, positions, rcond=None)[0]).max(axis=0)
    moving = extents > max(1e-9 * np.abs(positions).max(initial=0.0), 1e-6)
    exact = moving & (errors <= AFFINE * extents)
    if exact.any():
        names = np.array(coordinate_columns(len(exact) // 3))[exact]
        yield (
            f"An affine map of {_listed(command_columns(commands.shape[1]))} gives {_listed(names)} to a "
            "ten-thousandth of the range"
        )


def _differences(commands: Array, positions: Array) -> Iterator[str]:
    """Commands that are a coordinate of one marker less that of another."""
    names, told = coordinate_columns(positions.shape[1] // 3), command_columns(commands.shape[1])
    extents = np.ptp(commands, axis=0)
    for one, other in combinations(range(len(names)), 2):
        if (other - one) % 3:
            continue
        difference = positions[:, one] - positions[:, other]
        misses = np.minimum(*(np.abs(commands - sign * difference[:, None]).max(axis=0) for sign in (1.0, -1.0)))
        for place in np.flatnonzero((extents > 0) & (misses <= AFFINE * extents)):
            yield f"{told[place]} is the difference of {names[one]} and {names[other]}"


def _unit_norms(commands: Array) -> Iterator[str]:
    names, first = command_columns(commands.shape[1]), 0
    varies = np.ptp(commands, axis=0) > UNIT_NORM
    while first < len(names) - 2:
        length = next(
            (
                length
                for length in (4, 3)
                if first + length <= len(names)
                and varies[first : first + length].sum() > 1
                and np.abs(np.linalg.norm(commands[:, first : first + length], axis=1) - 1).max() < UNIT_NORM
            ),
            0,
        )
        if length:
            yield f"{_listed(names[first : first + length])} are of unit norm in every row"
        first += length or 1


def _copies(commands: Array, positions: Array) -> Iterator[str]:
    names = [*command_columns(commands.shape[1]), *coordinate_columns(positions.shape[1] // 3)]
    values = np.column_stack([commands, positions])
    extents, sizes = np.ptp(values, axis=0), np.linalg.norm(values, axis=0)
    moving = np.flatnonzero(extents > COPY * np.maximum(1.0, np.abs(values).max(axis=0)))
    unit = values[:, moving] / sizes[moving]
    near = np.abs(np.abs(unit.T @ unit) - 1) < 1e-9
    for one, other in combinations(range(len(moving)), 2):
        if near[one, other]:
            first, second = moving[one], moving[other]
            factor = values[:, first] @ values[:, second] / sizes[first] ** 2
            if np.abs(values[:, second] - factor * values[:, first]).max() <= COPY * extents[second]:
                yield f"{names[second]} is {factor:.6g} times {names[first]}"


def _pairs(commands: Array, positions: Array) -> Iterator[str]:
    """Commands that nearly equal another command or a position, and are no copy of it."""
    n_commands = commands.shape[1]
    names = [*command_columns(n_commands), *coordinate_columns(positions.shape[1] // 3)]
    values = np.column_stack([commands, positions])
    extents = np.ptp(values, axis=0)
    for one in range(n_commands):
        for other in range(one + 1, len(names)):
            extent = min(extents[one], extents[other])
            difference = values[:, one] - values[:, other]
            typical = float(np.sqrt((difference**2).mean()))
            limit = PAIR if other < n_commands else PAIR_OF_KINDS
            if COPY * extent < typical <= limit * extent:
                yield f"{names[one]} and {names[other]} differ by {typical / extent:.2%} of their range"


def _running(samples: Mapping[str, Samples]) -> Iterator[str]:
    commands = stacked_commands(samples)
    for place, name in enumerate(command_columns(commands.shape[1])[:MAX_COLUMNS]):
        grows = all((np.diff(rows.commands[:, place]) > 0).all() for rows in samples.values())
        steps = np.diff(np.sort(commands[:, place])) if grows else np.zeros(1)
        if steps.max() > 0 and np.ptp(steps) <= COPY * np.abs(commands[:, place]).max() + 1e-9 * steps.max():
            yield f"{name} grows by {np.median(steps):.6g} from row to row"


def _scale(values: Array) -> Array:
    spread = values.std(axis=0)
    return np.asarray(np.where(spread > 0, spread, 1.0))


def _listed(names: Iterable[str]) -> str:
    shown = list(names)
    return ", ".join(shown[:12]) + (f" and {len(shown) - 12} more" if len(shown) > 12 else "")
