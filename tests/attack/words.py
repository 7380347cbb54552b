# SPDX-License-Identifier: GPL-3.0-or-later
"""Command lines of any words for valid inputs, and inputs that are no regular file: refused with one line that names the
file, or solved to the end; after a failure everything is as it was before."""
import os
import shutil

from bench import Fall
from command_lines import OUTPUT, command_line, must_be_refused
from small_scene import kept_whole, limits, small_scenes
from written_files import check_words, check_written

LINES = 60  # of one round
TABLES = {"t.csv", "e.csv", "m.csv", "o.csv", "times.json"}  # that a command line may ask for
# How a refusal names a file that is not in the folder: the path that the input gave, whatever it is.
OTHER_FILES = ["output", ".h5", ".csv", "/dev/", "/proc/", ": cannot be opened: ", ": is not a regular file"]


class Words:
    def __init__(self, bench):
        self.bench, self.scenes = bench, small_scenes(bench)
        self.accepted = 0

    @property
    def what(self):
        return f"command lines, of which {self.accepted} were accepted"

    def round(self, random, folder):
        """Files are copies, since any of them may come to be an output."""
        self.scenes.lay_out(folder)
        lay_traps(folder)
        for path in folder.iterdir():
            if path.is_symlink() and path.exists():
                shutil.copyfile(path, copy := path.with_name(".copy"))
                copy.replace(path)
        lines = self.bench.of_round(LINES)
        with kept_whole(folder):
            for _ in range(lines):
                for name in os.listdir(folder):
                    if name.startswith(OUTPUT) or name in TABLES:
                        shutil.rmtree(folder / name) if (folder / name).is_dir() else (folder / name).unlink()
                self._try(*command_line(random, self.scenes), folder)
                if (folder / "fallen").exists():
                    raise Fall("a word was run as a command")
        return lines

    def _try(self, words, options, folder):
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
            check_new(folder / name, words)


def check_new(path, words):
    """A file that a command line has made: tables, and outputs of HDF5, which fields and samples are not."""
    if path.name in TABLES or not any(word.startswith(("--field", "--sample")) for word in words):
        check_written(path)


def lay_traps(folder):
    """What words of a command line may lead to."""
    (folder / "a-folder").mkdir()
    (folder / "empty").touch()
    (folder / "binary").write_bytes(bytes(range(256)) * 64)
    os.mkfifo(folder / "fifo")
    (folder / "loop").symlink_to("loop")
    (folder / "dangling").symlink_to("nowhere")
