# SPDX-License-Identifier: GPL-3.0-or-later
"""The BLAS that programs take, and its kernels: blas_test.py BIN_FOLDER."""
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def check_one_blas(bin_folder):
    """GSL's dense products come from the BLAS of the programs, not from the plain one that libgsl loads."""
    for program in ("stage1_plate", "stage3_nonlinear"):
        told = subprocess.run([bin_folder / program, "--version"], capture_output=True, text=True,
                              env={**os.environ, "LD_BIND_NOW": "1", "LD_DEBUG": "bindings"}).stderr
        found = set(re.findall(r"binding file \S*/libgsl\.so\S* \[0\] to (\S+) \[0\]: normal symbol `cblas_dgemm'", told))
        assert len(found) == 1 and "gslcblas" not in min(found), (program, found)


def kernels(bin_folder, folder, asked=None):
    """Kernels that a run tells of; `asked` is what the user wants of OpenBLAS."""
    environment = {name: value for name, value in os.environ.items() if name != "OPENBLAS_CORETYPE"}
    times = folder / "times.json"
    subprocess.run([bin_folder / "stage1_plate", ROOT / "examples/lap_joint/upper.json", "-o", folder / "upper.h5", "--p", "1",
                    "--quiet", "--timings", times], check=True,
                   env=environment | ({"OPENBLAS_CORETYPE": asked} if asked else {}))
    return json.loads(times.read_text())["blas_kernels"]


def check_kernels(bin_folder, folder):
    """No processor with AVX2 gets kernels from before it, unless the user asks for them."""
    found = kernels(bin_folder, folder)
    if not found or "avx2" not in Path("/proc/cpuinfo").read_text().split():
        return
    assert found != "Prescott", found
    assert kernels(bin_folder, folder, "Prescott") == "Prescott"
    assert kernels(bin_folder, folder, "Haswell") == "Haswell"


if __name__ == "__main__":
    check_one_blas(Path(sys.argv[1]))
    with tempfile.TemporaryDirectory() as name:
        check_kernels(Path(sys.argv[1]), Path(name))
