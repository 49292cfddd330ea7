from __future__ import annotations

import os
import subprocess
import sys
from unittest.mock import patch

import threadpoolctl

from softkin.core.threads import limited_threads

#: Libraries that are loaded one after the other, as models are built; each time every one of them must be limited.
LATE = """
import sys
from threadpoolctl import threadpool_info
from softkin.core.threads import limited_threads

def counts():
    return {pool["filepath"].rsplit("/", 1)[-1]: pool["num_threads"] for pool in threadpool_info()}

seen = set()
for module in ("numpy", "scipy.linalg", "sklearn.ensemble", "xgboost"):
    __import__(module)
    before = counts()
    print(module, sum(threads > 1 for pool, threads in before.items() if pool not in seen))
    seen |= set(before)
    with limited_threads(1):
        assert set(counts().values()) == {1}, (module, counts())
    assert counts() == before
"""


def test_libraries_that_are_loaded_late_are_limited_too() -> None:
    variables = {"OMP_NUM_THREADS": "3", "OPENBLAS_NUM_THREADS": "3"}
    command = [sys.executable, "-c", LATE]
    printed = subprocess.run(command, env={**os.environ, **variables}, capture_output=True, text=True, check=False)
    assert printed.returncode == 0, printed.stderr
    loaded = dict(line.split() for line in printed.stdout.splitlines())
    assert int(loaded["sklearn.ensemble"]) > 0, "nothing of several threads was loaded late, so nothing was tested"


def test_libraries_are_looked_for_only_after_an_import() -> None:
    with limited_threads(1):
        pass
    looked = patch.object(threadpoolctl.ThreadpoolController, "_load_libraries", autospec=True)
    with looked as look:
        for _ in range(3):
            with limited_threads(1):
                pass
        assert look.call_count == 0
        with patch.dict(sys.modules, {"a_new_module": sys}), limited_threads(1):
            pass
        assert look.call_count == 1
    threadpoolctl.reset_cached_controller()


def test_limits_nest() -> None:
    def counts() -> set[int]:
        return {pool["num_threads"] for pool in threadpoolctl.threadpool_info()}

    with limited_threads(2):
        with limited_threads(1):
            assert counts() == {1}
        assert counts() == {2}
