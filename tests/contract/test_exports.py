"""What every exported model must do: the same answers as the model, from a Python file and from a C header."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from softkin.models.plain.evaluate import KINDS
from softkin.models.plain.spaces import SPACES
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.export.c_header import c_header
from softkin.uncertainty.export.c_nodes import WRITERS
from softkin.uncertainty.export.c_robot import SPACE_WRITERS
from softkin.uncertainty.export.python_file import python_file
from tests.compiled_header import asked, compiled
from tests.exported_robots import NEW, ROBOTS, noiseless

LEVELS = (0.7, 0.9)
#: mm.
PARITY = 1e-9
needs_cc = pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler, cc")


def exported(name: str) -> Any:
    return exported_robot(ROBOTS[name]())


def exported_robot(robot: CalibratedModel) -> Any:
    namespace: dict[str, Any] = {"__name__": "exported"}
    exec(compile(python_file(robot, LEVELS, name="exported"), "exported.py", "exec"), namespace)
    return namespace["model"]


def test_all_kinds_can_be_written_in_both_languages() -> None:
    assert set(WRITERS) == set(KINDS)
    assert set(SPACE_WRITERS) == set(SPACES)


@pytest.mark.parametrize("name", ROBOTS)
def test_a_python_file_answers_as_the_model(name: str) -> None:
    robot, model = ROBOTS[name](), exported(name)
    np.testing.assert_allclose(model.predict(NEW), robot.predict(NEW), rtol=0, atol=PARITY)
    for level in LEVELS:
        np.testing.assert_allclose(model.intervals(NEW, level), robot.intervals(NEW, level), rtol=0, atol=PARITY)
    np.testing.assert_array_equal(model.is_outside(NEW), robot.is_outside(NEW))
    assert 0 < np.asarray(robot.is_outside(NEW)).sum() < len(NEW)
    np.testing.assert_array_equal(model.failure_probability(NEW), robot.failure_probability(NEW))
    loop, state = model.start(level=0.7), robot.start(confidence_level=0.7)
    for command in NEW[:8]:
        np.testing.assert_allclose(loop.step(command), state.step(command), rtol=0, atol=PARITY)


@needs_cc
@pytest.mark.parametrize("name", ROBOTS)
def test_a_c_header_answers_as_the_model(name: str, tmp_path: Path) -> None:
    robot = ROBOTS[name]()
    program = compiled(c_header(robot, LEVELS, name="arm"), "arm", tmp_path)
    n_coordinates, bounds = robot.known.truth.shape[1], np.asarray(robot.intervals(NEW, 0.7))
    ask = partial(asked, program, NEW, n_coordinates, failures=robot.failures is not None)
    one = ask(level=0.7)
    np.testing.assert_allclose(one.position, robot.predict(NEW), rtol=0, atol=PARITY)
    np.testing.assert_allclose(one.lower, bounds[..., 0], rtol=0, atol=PARITY)
    np.testing.assert_allclose(one.upper, bounds[..., 1], rtol=0, atol=PARITY)
    np.testing.assert_array_equal(one.outside, robot.is_outside(NEW))
    if robot.failures is not None:
        np.testing.assert_array_equal(one.failure_probability, robot.failure_probability(NEW))
        np.testing.assert_array_equal(one.may_fail, robot.failures.may_fail(NEW, [0.7])[0])
        assert 0 < np.asarray(one.may_fail).sum() < len(NEW)
    followed = ask(level=0.9, session=0)
    np.testing.assert_allclose(followed.position, robot.follow(NEW), rtol=0, atol=PARITY)


def test_a_python_file_says_which_poses_may_fail() -> None:
    robot, model = ROBOTS["failing"](), exported("failing")
    assert robot.failures is not None
    for level in LEVELS:
        np.testing.assert_array_equal(model.may_fail(NEW, level), robot.failures.may_fail(NEW, [level])[0])
    assert 0 < model.may_fail(NEW).sum() < len(NEW)
    assert model.failure_probability([1e60, 0.0]) == robot.failure_probability([1e60, 0.0])
    assert exported("ridge").failure_probability(NEW) is None
    assert not exported("ridge").may_fail(NEW).any()


@needs_cc
def test_sums_that_cancel_are_the_same_in_all_languages_at_ten_thousand_commands(tmp_path: Path) -> None:
    robot, model = noiseless(), exported_robot(noiseless())
    commands = np.random.default_rng(1).uniform(-1.4, 1.4, (10_000, 2))
    program = compiled(c_header(robot, LEVELS, name="arm"), "arm", tmp_path)
    c, bounds = asked(program, commands, 3, level=0.9), model.intervals(commands, 0.9)
    assert 0 < c.outside.sum() < len(commands)
    np.testing.assert_array_equal(c.outside, robot.is_outside(commands))
    np.testing.assert_allclose(c.position, model.predict(commands), rtol=0, atol=PARITY)
    np.testing.assert_allclose(np.stack([c.lower, c.upper], axis=-1), bounds, rtol=0, atol=PARITY)
    for row in range(0, len(commands), 100):
        np.testing.assert_allclose(c.position[row], robot.predict(commands[row])[0], rtol=0, atol=PARITY)
        np.testing.assert_allclose(bounds[row], robot.intervals(commands[row], 0.9)[0], rtol=0, atol=PARITY)
    kernel = robot._prepared.numbers["members"][0]["regressor"]["inner"]
    assert "expansion" in kernel


@needs_cc
def test_a_known_session_has_its_zero_in_c_too(tmp_path: Path) -> None:
    robot = ROBOTS["remembers"]()
    program = compiled(c_header(robot, LEVELS, name="arm"), "arm", tmp_path)
    state, answers = robot.start(session=2), asked(program, NEW, 3, level=0.9, session=2)
    steps = [state.step(command) for command in NEW]
    np.testing.assert_allclose(answers.lower, [step.lower for step in steps], rtol=0, atol=PARITY)
    for level, session in ((0.8, None), (0.9, 7)):
        with pytest.raises(subprocess.CalledProcessError):
            asked(program, NEW, 3, level=level, session=session)
    with pytest.raises(subprocess.CalledProcessError):
        asked(program, np.full((1, 2), np.nan), 3, level=0.9)


def test_a_python_file_runs_where_there_is_numpy_alone(tmp_path: Path) -> None:
    robot, packages = ROBOTS["gp"](), tmp_path / "packages"
    packages.mkdir()
    place = Path(np.__file__).parent
    for folder in (place, place.with_name("numpy.libs")):
        if folder.exists():
            (packages / folder.name).symlink_to(folder)
    (tmp_path / "arm.py").write_text(python_file(robot, LEVELS, name="arm"))
    code = f"import sys; sys.path += [{str(packages)!r}, {str(tmp_path)!r}]\n"
    code += "import importlib.util as u, json\nfrom arm import model\n"
    code += f"commands = {NEW[:3].tolist()}\n"
    code += "print(json.dumps([u.find_spec('sklearn') is None, model.intervals(commands, 0.9).tolist()]))"
    done = subprocess.run([sys.executable, "-I", "-S", "-c", code], capture_output=True, text=True, check=True)
    is_alone, bounds = json.loads(done.stdout)
    assert is_alone
    np.testing.assert_allclose(bounds, robot.intervals(NEW[:3], 0.9), rtol=0, atol=PARITY)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda m: m.intervals(NEW, 0.8), r"0.8 is none of the stored levels \[0.7, 0.9\]"),
        (lambda m: m.predict(NEW.T), r"expected numbers of shape \(n_rows, 2\)"),
        (lambda m: m.predict([["a", "b"]]), "expected numbers"),
        (lambda m: m.predict([[0.0, np.nan]]), "row 0 has no finite number"),
        (lambda m: m.start(session=1), "no session 1 in its recording"),
        (lambda m: m.start().step(NEW), "80 commands, where one is sent at a time"),
    ],
)
def test_wrong_calls_of_a_python_file_get_a_sentence(call: Any, says: str) -> None:
    with pytest.raises(ValueError, match=says):
        call(exported("ridge"))
