# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged plates, joints and studies: refused with one line that names the file, or solved to the end by all stages, whose
results hold no NaN; after a failure everything is as it was before."""
import json
import os
import shutil

import h5py

from bench import Fall
from follow_plate import joint_on_ground
from json_mutants import mutant
from small_scene import STUDIED, kept_whole, limits, small_scenes
from written_files import Folder, check_words

MUTANTS = 60    # of one round
OPTIONS = [[], [], [], ["--quiet"], ["--sensitivities"], ["--rim-stresses"], ["--verbose"], ["--all-stresses"],
           ["--csv", "t.csv"], ["--totals", "t.csv"], ["--envelope", "t.csv"], ["--margins", "t.csv"]]
# What a mutant may also be: no regular file at all.
STRANGE = ["a-folder", "empty", "binary", "fifo", "loop", "dangling", "/dev/null", "/dev/zero", "/dev/full", "/proc/self/environ",
           "missing.json", "a-folder/missing.json", "x" * 300, "y/" * 2500 + "z", "plate_strap.h5", "rivet.csv", "study.csv"]
# How a refusal names a file that is not in the folder: the path that the input gave, whatever it is.
OTHER_FILES = ["output", ".h5", ".csv", "/dev/", "/proc/", ": cannot be opened: ", ": is not a regular file"]


class DamagedJson:
    def __init__(self, bench):
        self.bench = bench
        self.accepted = 0

    @property
    def what(self):
        return f"mutants of JSON, of which {self.accepted} were accepted"

    def round(self, random, folder):
        """Mutants of one file; every other one stands beside an earlier output, which a failure must leave."""
        scenes = small_scenes(self.bench)
        scenes.lay_out(folder)
        self._lay_traps(folder)
        kind = random.choice(["plate", "joint", "study"])
        name = random.choice({"plate": scenes.plates, "joint": scenes.joints, "study": scenes.studies}[kind])
        text = (scenes.folder / name).read_text()
        with kept_whole(folder):
            mutants = self.bench.of_round(MUTANTS)
            for _ in range(mutants):
                (folder / "mutant.json").write_bytes(mutant(random, text))
                self._try(kind, "mutant.json", folder, random)
                if (folder / "fallen").exists():
                    raise Fall("a name in the input was run as a command")
            self._try(kind, random.choice(STRANGE), folder, random)
        return mutants + 1

    @staticmethod
    def _lay_traps(folder):
        """What paths of a mutant may lead to."""
        (folder / "a-folder").mkdir()
        (folder / "empty").touch()
        (folder / "binary").write_bytes(bytes(range(256)) * 64)
        os.mkfifo(folder / "fifo")
        (folder / "loop").symlink_to("loop")
        (folder / "dangling").symlink_to("nowhere")

    def _run(self, folder, words, output, random, also=(), writes=True):
        """One run under all rules, and whether it did its work. `also` are names that it may write besides, or, where it does not
        write its output, alone."""
        state = Folder(folder, output, random.random() < 0.5)
        outcome = self.bench.run(*words, "-o", output, cwd=folder, limits=limits(self.bench))
        named = [*words[1:], *(path.name for path in folder.iterdir()), *OTHER_FILES]
        check_words(outcome, named)
        state.check(outcome, also, writes)
        return outcome.status == 0

    def _try(self, kind, name, folder, random):
        shutil.rmtree(folder / "output.h5.parts", ignore_errors=True)
        (folder / "t.csv").unlink(missing_ok=True)
        {"plate": self._try_plate, "joint": self._try_joint, "study": self._try_study}[kind](name, folder, random)

    def _try_plate(self, name, folder, random):
        options = random.choice([[], [], [], ["--p", "2"], ["--accuracy", "1e-3"]])
        if not self._run(folder, ["stage1_plate", name, *options], "output.h5", random):
            return
        self.accepted += 1
        shutil.copyfile(folder / "output.h5", folder / "input.h5")
        if not self._run(folder, ["stage2_extract", "input.h5"], "output.matrices.h5", random):
            return
        shutil.copyfile(folder / "output.matrices.h5", folder / "input.matrices.h5")
        if joint_on_ground(folder / "input.matrices.h5", folder / "ground.json"):
            if self._run(folder, ["stage3_nonlinear", "ground.json"], "joint.h5", random):
                self._run(folder, ["stage2_extract", "input.h5", "--field", "joint.h5"], "output.vtu", random)

    def _try_joint(self, name, folder, random):
        options = random.choice(OPTIONS)
        words = ["stage3_nonlinear", name, *options]
        if not self._run(folder, words, "output.h5", random, also=["t.csv"]):
            return
        self.accepted += 1
        shutil.copyfile(folder / "output.h5", folder / "input.h5")
        with h5py.File(folder / "input.h5") as result:
            plate = result["plate/name"].asstr()[0]
            solution = f"{name_of_solution(result['input'].asstr()[()], plate)}.h5"
        if (folder / solution).is_symlink():
            self._run(folder, ["stage2_extract", solution, "--field", "input.h5", "--plate", plate], "output.vtu", random)

    def _try_study(self, name, folder, random):
        options = random.choice([[], [], [], ["--sample", "0"], ["--slice", "1/2"], ["--merge"], ["--threads", "2"]])
        output = "output.json" if "--sample" in options else "output.h5"
        words = ["stage3_nonlinear", STUDIED, "--study", name, *options]
        parts = ["output.h5.parts"]
        if "--slice" in options:  # leaves blocks and no output
            if self._run(folder, words, output, random, parts, writes=False):
                self._run(folder, [*words[:-1], "2/2"], output, random, parts, writes=False)
            words = [*words[:4], "--merge"]
        self.accepted += self._run(folder, words, output, random, parts)


def name_of_solution(text, plate):
    """Name without ending of the PLATE.h5 of a plate, by the file of its matrices in the joint's text."""
    try:
        file = json.loads(text)["plates"][plate]
        return (file["file"] if isinstance(file, dict) else file).removesuffix(".matrices.h5")
    except (ValueError, KeyError, TypeError):  # comments, or what Python does not take
        return "nothing"
