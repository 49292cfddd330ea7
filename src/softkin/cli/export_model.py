"""Write a calibrated model for other machines, in the forms that are asked for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from softkin.core.files import replacing
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.export.c_header import c_header
from softkin.uncertainty.export.c_text import identifier
from softkin.uncertainty.export.numbers import LEVELS
from softkin.uncertainty.export.onnx_file import onnx_file
from softkin.uncertainty.export.python_file import python_file
from softkin.uncertainty.export.rounding import known_to
from softkin.uncertainty.orientation_model import ORIENTATION

#: Form -> ending of its file, and what writes its content of a model, its levels and the name of what it defines.
FORMS: dict[str, tuple[str, Callable[[CalibratedModel, Sequence[float], str], str | bytes]]] = {
    "python": (".py", lambda robot, levels, name: python_file(robot, levels, name=name)),
    "c": (".h", lambda robot, levels, name: c_header(robot, levels, name=name)),
    "onnx": (".onnx", lambda robot, levels, _: onnx_file(robot, levels)),
}


def remarks(robot: CalibratedModel) -> list[str]:
    """What the model answers and exported files do not, and how exactly its positions are known, in sentences."""
    not_carried = "exported files give positions: the orientation of the tip stays in the calibrated model"
    return [sentence for sentence in (not_carried * (ORIENTATION in robot.about), known_to(robot)) if sentence]


def written(
    robot: CalibratedModel, folder: Path, forms: Sequence[str], levels: Sequence[float] | None, name: str | None
) -> list[Path]:
    """The files that a model was written to.

    Parameters:
        robot: the calibrated model.
        folder: that they go to; it is made where it is missing.
        forms: keys of `FORMS`.
        levels: confidence levels that intervals are stored at; None: `LEVELS`.
        name: of the files and of what they define; None: that of the robot.

    Raises:
        ConfigError: a part of the model cannot be written, or a level is none; nothing is written then.
    """
    plain = identifier(name or robot.dataset)
    contents = {FORMS[form][0]: FORMS[form][1](robot, levels or LEVELS, plain) for form in forms}
    files = [folder / f"{plain}{ending}" for ending in contents]
    for path, content in zip(files, contents.values(), strict=True):
        with replacing(path) as temporary:
            temporary.write_bytes(content if isinstance(content, bytes) else content.encode())
    return files
