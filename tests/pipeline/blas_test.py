# SPDX-License-Identifier: GPL-3.0-or-later
"""GSL's dense products come from the BLAS of the programs, not from the plain one that libgsl loads: blas_test.py BIN_FOLDER."""
import os
import re
import subprocess
import sys
from pathlib import Path

for program in ("stage1_plate", "stage3_nonlinear"):
    told = subprocess.run([Path(sys.argv[1]) / program, "--version"], capture_output=True, text=True,
                          env={**os.environ, "LD_BIND_NOW": "1", "LD_DEBUG": "bindings"}).stderr
    found = re.findall(r"binding file \S*/libgsl\.so\S* \[0\] to (\S+) \[0\]: normal symbol `cblas_dgemm'", told)
    assert len(found) == 1 and "gslcblas" not in found[0], (program, found)
