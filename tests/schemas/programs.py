# SPDX-License-Identifier: GPL-3.0-or-later
"""The three programs, as tests in Python run them."""
import json
import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
ONE_THREAD = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


class Programs:
    """Each method runs one program on one input and returns what it said and how it ended."""

    def __init__(self, folder):
        folder = pathlib.Path(folder).resolve()
        self.stage1, self.stage2, self.stage3 = (folder / name for name in ("stage1_plate", "stage2_extract", "stage3_nonlinear"))
        ONE_THREAD["PATH"] = f"{folder}:{os.environ['PATH']}"  # for Makefiles

    def plate(self, scene, output, p):
        return run(self.stage1, scene, "-o", output, "--p", p)

    def matrices(self, solution, output):
        return run(self.stage2, solution, "-o", output)

    def joint(self, scene, output, *options):
        return run(self.stage3, scene, "-o", output, *options)

    def study(self, scene, output, joint):
        return run(self.stage3, joint, "--study", scene, "-o", output)

    def prepare_joint(self, scene, p):
        """Makes the matrices that a joint names, [FOLDER/]NAME.*.h5, from the NAME.json or else the Makefile beside it."""
        for plate in json.loads(scene.read_text())["plates"].values():
            plate = plate["file"] if isinstance(plate, dict) else plate
            output = scene.parent / plate
            source = scene.parent / f"{output.name.split('.')[0]}.json"
            solution = output.with_suffix(".solution")
            output.parent.mkdir(exist_ok=True)
            if source.exists() and not output.exists():
                must(self.plate(source, solution, p))
                must(self.matrices(solution, output))
            elif not output.exists():
                must(run("make", "-s", "-C", scene.parent, plate))


def run(*command):
    return subprocess.run([str(word) for word in command], env=ONE_THREAD, capture_output=True, text=True)


def must(result):
    if result.returncode != 0:
        raise SystemExit(f"{' '.join(result.args)}: exit {result.returncode}\n{result.stderr}")
    return result
