# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged and edited HDF5 files of every kind that a program reads.

A sealed file whose bytes changed is refused, or gives what it gave before. A file without a seal may be refused or not, but
ends no program by a signal, unless damage hits the HDF5 library itself, which is counted apart. A file edited with h5py is
refused with its name, or gives results without NaN; the same ones where the edit left all numbers as they were.
"""
import os
import shutil

import h5py

from bench import MOST_MEMORY, Fall
from hdf5_bytes import SEAL, SIGNATURE, damaged, same_numbers, unsealed
from hdf5_edits import CONTENT
from hdf5_layouts import LAYOUT, group_link, names, rewritten
from hdf5_library import falls_in_library
from small_scene import kept_whole, limits, small_scenes
from written_files import Folder, check_words

MUTANTS = 40  # of one round


class DamagedHdf5:
    def __init__(self, bench):
        self.bench, self.scenes = bench, small_scenes(bench)
        self.mutant = b""
        self.counts = {"accepted": 0, "refused": 0, "library crashes": 0}

    @property
    def what(self):
        return "mutants of HDF5 files; runs " + ", ".join(f"{name}: {count}" for name, count in self.counts.items())

    def round(self, random, folder):
        """Mutants of one file, all damaged in one way, each read by the same step."""
        scenes = self.scenes
        scenes.lay_out(folder)
        self._lay_traps(folder)
        name, step = random.choice(scenes.steps[random.choice(["plate", "matrices", "result", "block"])])
        how = random.choice([self._sealed, self._sealed, self._unsealed, self._edited, self._edited, self._edited, self._strange])
        tried = 0
        with kept_whole(folder, lambda: self.mutant):
            for _ in range(self.bench.of_round(MUTANTS if how != self._strange else 10)):
                target = folder / name
                self._clear(folder, target, scenes)
                tried += how(random, folder, scenes, target, step)
        return tried

    @staticmethod
    def _lay_traps(folder):
        """Where links and external storage lead to."""
        (folder / "a-folder").mkdir()
        (folder / "binary").write_bytes(bytes(range(256)) * 64)
        os.mkfifo(folder / "fifo")

    def _clear(self, folder, target, scenes):
        """Puts back the file that was damaged last, and the blocks of a study, which merging removes."""
        if target.is_dir() and not target.is_symlink():
            target.rmdir()
        elif os.path.lexists(target):
            target.unlink()
        (folder / "elsewhere.h5").unlink(missing_ok=True)
        if target.parent != folder:
            shutil.rmtree(target.parent, ignore_errors=True)
            shutil.copytree(scenes.folder / target.parent.name, target.parent)
            target.unlink()

    def _run(self, random, folder, step, target, seal):
        """One run of the step under all rules: its outcome, or None if the HDF5 library crashed, or went round and round,
        at bytes without a seal."""
        parts = [target.parent.name] if target.parent != folder else []
        self.mutant = target.read_bytes() if not target.is_symlink() else b""
        state = Folder(folder, step.output, random.random() < 0.3)
        try:
            longest = 20 if seal else 2 if self.bench.sanitized else 5  # which sanitized programs have ten times
            outcome = self.bench.run(*step.command(), cwd=folder, limits=limits(self.bench), longest=longest)
        except Fall as fall:
            if not seal and self._is_of_library(str(fall), folder, step):
                self.counts["library crashes"] += 1
                return None
            raise
        check_words(outcome, [target.name, target.parent.name])
        state.check(outcome, parts)
        self.counts["refused" if outcome.status else "accepted"] += 1
        return outcome

    def _is_of_library(self, text, folder, step):
        """Whether a fall at damaged bytes without a seal is the HDF5 library's: memory that it takes for a damaged text, a
        heap that it spoils, or a crash or endless loop within it (docs/limits.md)."""
        faults = "memory:", "ended by", "hang", "fault seen by a sanitizer"
        return text.startswith(faults) and falls_in_library(self.bench, step.command(), folder, MOST_MEMORY)

    def _must_agree(self, folder, scenes, step, why):
        if not same_numbers(folder / step.output, scenes.folder / step.output):
            raise Fall(f"{why} is accepted with other numbers in {step.output}")

    @staticmethod
    def _source(scenes, target):
        """The undamaged file; blocks of a study stand a folder deeper."""
        return scenes.folder / (target.name if target.parent.suffix != ".parts" else f"{target.parent.name}/{target.name}")

    def _sealed(self, random, folder, scenes, target, step):
        target.write_bytes(damaged(random, self._source(scenes, target).read_bytes()))
        outcome = self._run(random, folder, step, target, seal=True)
        if outcome.status == 0:
            seal = SEAL.search(self.mutant)
            self._must_agree(folder, scenes, step, f"damage of a sealed file{'' if seal else ', which took the seal along,'}")
        return 1

    def _unsealed(self, random, folder, scenes, target, step):
        target.write_bytes(damaged(random, unsealed(self._source(scenes, target).read_bytes())))
        self._run(random, folder, step, target, seal=False)
        return 1

    def _edited(self, random, folder, scenes, target, step):
        """One to three edits; what h5py itself does not make is no mutant."""
        harmless, source = True, self._source(scenes, target)
        shutil.copyfile(source, folder / "elsewhere.h5")
        try:
            if random.random() < 0.05:
                rewritten(random, source, target)
            else:
                target.write_bytes(unsealed(source.read_bytes()))
                with h5py.File(target, "r+") as file:
                    paths = names(file)  # each is edited once: h5py itself crashes at some that are edited already
                    for path in random.sample(paths, min(len(paths), random.choice([1, 1, 1, 1, 2, 3]))):
                        edit = random.choice(random.choice([CONTENT, LAYOUT]))
                        harmless = bool(edit(random, file, path)) and harmless
                        if edit == group_link:
                            break
        except (ValueError, TypeError, OSError, KeyError, RuntimeError, IndexError, OverflowError, MemoryError, AttributeError):
            return 0
        outcome = self._run(random, folder, step, target, seal=True)
        if harmless and outcome.status != 0 and "/digest: " not in outcome.stderr:  # a joint may name the digest that it wants
            raise Fall(f"an edit that changes no number is refused: {outcome.stderr[-500:]}")
        if harmless and outcome.status == 0:
            self._must_agree(folder, scenes, step, "an edit that changes no number")
        return 1

    def _strange(self, random, folder, scenes, target, step):
        """No HDF5 file, or no file at all."""
        data = self._source(scenes, target).read_bytes()
        texts = [b"", b"\n", SIGNATURE, SIGNATURE + b"\x00" * 100, SIGNATURE + b"\xff" * 1000, bytes(512) + SIGNATURE, b"{}",
                 SEAL.search(data)[0], SEAL.search(data)[0] * 2, SIGNATURE + random.randbytes(4000), random.randbytes(4000),
                 bytes(512) + data, bytes(1024) + unsealed(data), data * 2, unsealed(data) * 2, data[:8] + b"\x01" + data[9:],
                 unsealed(data)[:8] + bytes([random.randrange(256)]) + data[9:], b"\x7fELF" + bytes(100)]
        links = ["/dev/zero", "/dev/null", "/dev/full", "a-folder", "fifo", target.name, "nowhere", "/proc/self/mem", "/"]
        if random.random() < 0.6:
            target.write_bytes(random.choice(texts))
        else:
            target.symlink_to(random.choice(links) if target.parent == folder else "../fifo")
        self._run(random, folder, step, target, seal=target.is_symlink())  # what is no file is not for HDF5 to open
        return 1
