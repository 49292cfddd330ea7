"""The readable page (Markdown) of a data card."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from softkin.core.escaping import markdown_text
from softkin.core.samples import SUBSETS, TRAIN
from softkin.data.audit.findings import counted
from softkin.data.orientation import KEY
from softkin.data.readers.columns import ORIENTATION, UNUSED
from softkin.data.readers.complete_rows import GAPS, LOST_MARKERS, UNJOINED
from softkin.data.scored_rows import DRAWN_FROM

OTHERS = [subset for subset in SUBSETS if subset != TRAIN]
#: The page shows this many row numbers of a finding and this many columns of a long table; the JSON has more, and all.
MAX_ROWS_SHOWN, MAX_COLUMNS_SHOWN = 10, 12

VERDICTS = {
    "leak": "**Leak.** Scores on subsets that a leak names are training error; their tables are marked.",
    "warning": "**With care.** Read the findings before you trust a score.",
    "note": "**Sound.** There are notes, none of which touches the scores.",
    None: "**Sound.** There are no findings.",
}


def page(card: Mapping[str, Any]) -> str:
    """The page of a data card, the dictionary that is written as JSON."""
    checks, unit = card["checks"], card["unit"]
    parts = [
        f"# Data card: {markdown_text(card['title'])}",
        f"`{card['dataset']}`. {VERDICTS[card['worst_severity']]}",
        "## Findings",
        *([_finding(finding) for finding in card["findings"]] or ["None."]),
        "## The rows",
        _rows(card),
        *_removed(card["removed_from_train"]),
        *_not_read(card),
        *_relabelled(card.get("relabelled_rows")),
        *_unused(card),
        "## Ranges",
        f"Commands in the file's own unit, positions in {unit} (the file has {card['unit_in_file']}).",
        _ranges(card["subsets"]),
        "## Where the base stands",
        _base(card["base"], unit),
        "## How near the other subsets come to train",
        _nearness(checks["near_copies"]),
        "## How far they lie from train",
        _shift(checks["extrapolation_support"], checks["subset_shift"]),
        "## How smooth the robot is",
        _regularity(checks["gross_outliers"], unit),
        *_in_time(checks["memory"], unit),
    ]
    return "\n\n".join(parts) + "\n"


def _finding(finding: Mapping[str, Any]) -> str:
    text = f"- **{finding['severity']}**, `{finding['code']}`: {markdown_text(finding['sentence'])} "
    text += f"*{markdown_text(finding['consequence'])}*"
    for subset, count in finding["n_rows"].items():
        shown = ", ".join(map(str, finding["rows"][subset][:MAX_ROWS_SHOWN]))
        more = ", ..." if count > MAX_ROWS_SHOWN else ""
        text += f"\n  - {subset}, {counted(count, 'row')} (numbered from 0): {shown}{more}"
    return text


def _rows(card: Mapping[str, Any]) -> str:
    distinct, duplicates = card["checks"]["few_commands"], card["checks"]["duplicate_rows"]["rows"]
    copied = card["checks"]["copied_commands"]
    rows = [
        [
            subset,
            card["subsets"][subset]["rows"],
            distinct["distinct"][subset],
            duplicates[subset],
            copied[subset]["rows"] if subset in copied else "",
        ]
        for subset in SUBSETS
    ]
    header = ["subset", "rows", "distinct commands", "duplicate rows", "rows whose command is in train"]
    return (
        f"{_table(header, rows)}\n\nDistinct commands in all subsets together: {distinct['distinct_in_all_subsets']}."
    )


def _removed(removed: Mapping[str, int] | None) -> list[str]:
    if removed is None:
        return []
    counts = ", ".join(f"{count} {kind.replace('_', ' ')}" for kind, count in removed.items())
    return [f"Dropped from train by `clean`: {counts}. All numbers here are without them."]


def _not_read(card: Mapping[str, Any]) -> list[str]:
    """What of the file was left out, where the entry asks for that."""
    said = []
    if GAPS in card:
        said.append(f"Left out by `missing`, since a number is missing: {counted(card[GAPS], 'row')} of the file.")
    for marker in card.get(LOST_MARKERS, ()):
        columns = markdown_text(", ".join(marker["columns"]))
        said.append(f"Left out by `missing`, since the marker is lost in {counted(marker['rows'], 'row')}: {columns}.")
    if UNJOINED in card:
        said.append(f"Left out by `join`, since they have no partner: {counted(card[UNJOINED], 'row')}.")
    for subset, count in card.get(DRAWN_FROM, {}).items():
        left = card["subsets"][subset]["rows"]
        said.append(f"Of {subset} {left} of {count} rows are kept, drawn at random (`max_scored_rows`).")
    return said


def _relabelled(counts: Mapping[str, int] | None) -> list[str]:
    if counts is None:
        return []
    listed = ", ".join(f"{count} of {subset}" for subset, count in counts.items())
    return [f"Markers put back in order by `relabel: true`, rows: {listed}."]


def _unused(card: Mapping[str, Any]) -> list[str]:
    """Columns of the file that the entry names nowhere; those of the orientation that it names, which is predicted."""
    said = [
        f"{what}: {_listed(card[key])}."
        for key, what in (
            (UNUSED, "Columns of the file that the entry does not name"),
            (ORIENTATION, "An orientation by their names, which is modelled where the entry names it (`orientation`)"),
        )
        if key in card
    ]
    said += [f"Orientation of the tip, {card[KEY]['kind']}: {_listed(card[KEY]['columns'])}."] if KEY in card else []
    return [" ".join(said)] if said else []


def _listed(names: Sequence[str]) -> str:
    more = f" and {len(names) - MAX_COLUMNS_SHOWN} more" if len(names) > MAX_COLUMNS_SHOWN else ""
    return markdown_text(", ".join(names[:MAX_COLUMNS_SHOWN]) + more)


def _ranges(subsets: Mapping[str, Any]) -> str:
    columns = [(kind, name) for kind in ("commands", "positions_mm") for name in subsets[TRAIN][kind]]
    rows = [
        [name, *("{:.4g} to {:.4g}".format(*subsets[subset][kind][name]) for subset in SUBSETS)]
        for kind, name in columns[:MAX_COLUMNS_SHOWN]
    ]
    left = len(columns) - len(rows)
    return _table(["column", *SUBSETS], rows) + (f"\n\n{left} more columns are in the JSON file." if left else "")


def _base(base: Mapping[str, Any], unit: str) -> str:
    if "not_measured" in base:
        return f"Not measured: {base['not_measured']}."
    origin = ", ".join(
        f"{name} {value:.4g} ({how})"
        for name, value, how in zip("xyz", base["origin_mm"], base["origin_from"], strict=True)
    )
    axis = ", ".join(f"{value:.4g}" for value in base["axis"])
    refused = (
        f" It was estimated {base['refused_mm']:.3g} {unit} from the nearest marker, farther than the robot is long: "
        "that is not used, and the base is as far away as the robot is long. Declare it, if curvature coordinates "
        "matter."
        if "refused_mm" in base
        else ""
    )
    return (
        f"At {origin} {unit}; the straight robot leaves it along ({axis}), {base['axis_from']}. Models in "
        "curvature coordinates are fitted to the arcs from there to the markers. `base` in the entry declares it."
        f"{refused}"
    )


def _nearness(near: Mapping[str, Any]) -> str:
    if "not_measured" in near:
        return f"Not measured: {near['not_measured']}."
    rows = [
        [
            subset,
            near[subset]["rows_looked_at"],
            f"{near[subset]['nearest_distance_min']:.3g}",
            f"{near[subset]['nearest_distance_median']:.3g}",
            near[subset]["near_copies"],
        ]
        for subset in OTHERS
    ]
    return (
        f"Distance of a command to the nearest train command, in {near['unit']}, among "
        f"{near['train_commands_looked_at']} distinct train commands; these lie {near['typical_spacing']:.3g} apart "
        "(median). A near copy lies nearer than a hundredth of the spacing around it, and is not equal.\n\n"
        + _table(["subset", "rows looked at", "smallest", "median", "near copies"], rows)
    )


def _shift(support: Mapping[str, Any], shift: Mapping[str, Any]) -> str:
    rows = []
    for subset in SUBSETS:
        row = [subset, f"{support[subset]['norm_min']:.4g} to {support[subset]['norm_max']:.4g}"]
        if subset != TRAIN:
            auc, columns = shift[subset]["auc"], shift[subset]["columns"]
            worst = max(columns, key=lambda name: columns[name]["ks"])
            row += [
                f"{support[subset]['share_outside_hull']:.0%} of {support[subset]['rows_looked_at']}",
                "too few rows" if auc is None else f"{auc:.3f}",
                f"{columns[worst]['ks']:.3f} ({worst})",
            ]
        rows.append(row + [""] * (5 - len(row)))
    return (
        f"The hull is that of {support['train_commands_looked_at']} distinct train commands. The AUC is that of a "
        "classifier of the subset's commands against those of train: 0.5 is chance, 1 never fails. KS is the "
        "largest gap between two cumulative distributions (0 to 1), here of the column that differs most; every "
        f"column's, and its Wasserstein distance, is in the JSON file. At most {shift['rows_classified_at_most']} rows "
        f"of a subset were classified and {shift['rows_compared_at_most']} compared, drawn with a fixed seed.\n\n"
        + _table(["subset", "command norm", "outside the hull", "AUC", "largest KS distance"], rows)
    )


def _regularity(outliers: Mapping[str, Any], unit: str) -> str:
    if "not_measured" in outliers:
        return f"Not measured: {outliers['not_measured']}."
    return (
        f"A robust polynomial of degree {outliers['degree_of_fit']}, fitted to {outliers['rows_fitted']} rows, leaves "
        f"a typical residual of {outliers['typical_residual_mm']:.2g} {unit}. It only finds outliers and is no point "
        "model. All rows were compared with it."
    )


def _in_time(memory: Mapping[str, Any], unit: str) -> list[str]:
    """What the recording says of time; nothing where there is none."""
    if "not_measured" in memory:
        return []
    rows = []
    for name, what in (
        ("remembers", "memory of earlier commands (standard deviation)"),
        ("sessions_differ", "widest difference of zeros between sessions"),
        ("drifts", "drift within a session"),
    ):
        measured = memory[name]
        if "not_measured" not in measured:
            effects = ", ".join(f"{column} {value:.2g}" for column, value in measured["effect_mm"].items())
            rows.append([what, effects, f"{measured['p_value']:.3g}"])
    text = (
        f"Residuals of a polynomial of degree {memory['degree_of_fit']} by commands alone, in the order of the "
        f"recording: {memory['rows_looked_at']} rows, {memory['permutations']} permutations.\n\n"
    )
    return ["## How it lives in time", text + _table(["effect", f"size, {unit}", "p-value"], rows)]


def _table(header: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(markdown_text(str(cell)) for cell in line) + " |" for line in lines)
