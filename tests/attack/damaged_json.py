# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged plates, joints, studies and the tables that they read: refused with one line that names the file, or solved
to the end by all stages, whose results hold no NaN; after a failure everything is as it was before. And command lines
of any words for files that are not damaged."""
import json
import os
import shutil

import h5py

import csv_mutants
from bench import Fall
from command_lines import OUTPUT, command_line, must_be_refused
from follow_plate import joint_on_ground
from hdf5_bytes import same_numbers
from json_mutants import mutant
from small_scene import STUDIED, kept_whole, limits, small_scenes
from written_files import Folder, check_words, check_written

MUTANTS = 60    # of one round
TABLES = {"t.csv", "e.csv", "m.csv", "o.csv", "times.json"}  # that a command line may ask for
OPTIONS = [[], [], [], ["--quiet"], ["--sensitivities"], ["--rim-stresses"], ["--verbose"], ["--all-stresses"],
           ["--distance", "0.5"], ["--distance", "1e-30", "--rim-stresses"], ["--case", "pull"],
           ["--csv", "t.csv"], ["--totals", "t.csv"], ["--envelope", "t.csv"], ["--margins", "t.csv"]]
# What a mutant may also be: no regular file at all.
STRANGE = ["a-folder", "empty", "binary", "fifo", "loop", "dangling", "/dev/null", "/dev/zero", "/dev/full", "/proc/self/environ",
           "missing.json", "a-folder/missing.json", "x" * 300, "y/" * 2500 + "z", "plate_strap.h5", "rivet.csv", "study.csv"]
# How a refusal names a file that is not in the folder: the path that the input gave, whatever it is.
OTHER_FILES = ["output", ".h5", ".csv", "/dev/", "/proc/", ": cannot be opened: ", ": is not a regular file"]


class DamagedJson:
    def __init__(self, bench):
        self.bench, self.scenes = bench, small_scenes(bench)
        self.accepted = 0

    @property
    def what(self):
        return f"mutants of JSON, of tables and of command lines, of which {self.accepted} were accepted"

    def round(self, random, folder):
        """Mutants of one kind; every other one stands beside an earlier output, which a failure must leave."""
        scenes = self.scenes
        scenes.lay_out(folder)
        self._lay_traps(folder)
        return random.choice([self._texts] * 4 + [self._tables, self._command_lines])(random, folder, scenes)

    def _texts(self, random, folder, scenes):
        """Mutants of one file."""
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

    def _tables(self, random, folder, scenes):
        """Mutants of the table of a law or of that of a study."""
        table, whole, words = random.choice([
            ("rivet.csv", "joint_formulas.h5", ["stage3_nonlinear", "joint_formulas.json"]),
            ("study.csv", "study_random.h5", ["stage3_nonlinear", STUDIED, "--study", "study_random.json"])])
        text = (scenes.folder / table).read_text()
        (folder / table).unlink()
        mutants = self.bench.of_round(MUTANTS)
        with kept_whole(folder):
            for _ in range(mutants):
                data, wanted = csv_mutants.mutant(random, text)
                (folder / table).write_bytes(data)
                accepted = self._run(folder, words, OUTPUT, random)
                self.accepted += accepted
                if accepted and wanted == csv_mutants.REFUSED:
                    raise Fall(f"{table} is accepted, which has to be refused: {data[:300]}")
                if accepted and wanted == csv_mutants.SAME and not same_numbers(folder / OUTPUT, scenes.folder / whole):
                    raise Fall(f"{table} is accepted with other numbers: {data[:300]}")
        return mutants

    def _command_lines(self, random, folder, scenes):
        """Files are copies here, since any of them may come to be an output."""
        for path in folder.iterdir():
            if path.is_symlink() and path.exists():
                shutil.copyfile(path, copy := path.with_name(".copy"))
                copy.replace(path)
        mutants = self.bench.of_round(MUTANTS)
        with kept_whole(folder):
            for _ in range(mutants):
                for name in os.listdir(folder):
                    if name.startswith(OUTPUT) or name in TABLES:
                        shutil.rmtree(folder / name) if (folder / name).is_dir() else (folder / name).unlink()
                self._try_words(*command_line(random, scenes), folder)
        return mutants

    def _try_words(self, words, options, folder):
        """One command line; what it may write are the files that it names, and parts of a study."""
        before = set(os.listdir(folder))
        outcome = self.bench.run(*words, cwd=folder, limits=limits(self.bench))
        self.accepted += outcome.status == 0
        given = {part for word in words for part in (word, word.split("=")[-1], word.removeprefix("-o"))}
        check_words(outcome, [*(given - {""}), *os.listdir(folder), "; see --help", *OTHER_FILES])
        extra = {name for name in os.listdir(folder) if name not in before and name.removesuffix(".parts") not in given}
        if extra:
            raise Fall(f"{words}: exit status {outcome.status} left {sorted(extra)}")
        why = must_be_refused(words, options)
        if why and outcome.status not in (2, 3):
            raise Fall(f"{words}: exit status {outcome.status}, though {why}")
        for name in set(os.listdir(folder)) & given - before if outcome.status == 0 else ():
            self._check_new(folder / name, words)

    @staticmethod
    def _check_new(path, words):
        """A file that a command line has made: tables, and outputs of HDF5, which fields and samples are not."""
        if path.name in TABLES or not any(word.startswith(("--field", "--sample")) for word in words):
            check_written(path)

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
        """One run under all rules, and whether it did its work. `also` are names that it may write besides, or alone
        where it does not write its output."""
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
        options = random.choice([[], [], [], ["--p", "2"], ["--accuracy", "1e-3"], ["--peak-accuracy", "1e-2"],
                                 ["--accuracy", "1e-10", "--peak-accuracy", "1e-6"]])
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
