# SPDX-License-Identifier: GPL-3.0-or-later
"""Python scripts of this repository, run in a test's own process, which so loads h5py and matplotlib once."""
import contextlib
import io
import runpy
import subprocess
import sys
from pathlib import Path
from unittest import mock

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


def run_script(name, *words):
    """What a user who calls the script gets: its status, and what it prints on stdout and stderr."""
    out, err = io.StringIO(), io.StringIO()
    status = 0
    with (mock.patch.object(sys, "argv", [str(SCRIPTS / name), *map(str, words)]),
          mock.patch.object(sys, "path", [str(SCRIPTS), *sys.path]),
          contextlib.redirect_stdout(out), contextlib.redirect_stderr(err)):
        try:
            runpy.run_path(str(SCRIPTS / name), run_name="__main__")
        except SystemExit as end:
            status = end.code or 0
            if isinstance(status, str):  # as Python's own exit says it
                print(status, file=err)
                status = 1
    return subprocess.CompletedProcess(words, status, out.getvalue(), err.getvalue())
