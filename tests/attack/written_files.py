# SPDX-License-Identifier: GPL-3.0-or-later
"""What the programs leave behind: result files without NaN, infinite numbers only where schemas/*.md say so, nothing
unfinished, and after a failure what was there before."""
import csv
import re
import sys
from functools import cache

import h5py
import numpy as np

from bench import ROOT, Fall

PAGES = {"plate-solution": "plate-solution.md", "plate-matrices": "plate-matrices.md", "joint-result": "joint-result.md",
         "study-result": "study-result.md"}
# Infinite at limit loads, limits of grids, loads that do not act in a case, and squares above 1.8e308: of these the rows of
# the pages' tables do not speak.
INFINITE_TOO = {"joint-result": r"F_error|sensitivity/.*|envelope/.*|margin/(allowable|applied)|stiffness/tangent|"
                                r"plates/[^/]+/(crack/K_I+_error|row/after)",
                "study-result": r"statistics/[^/]+/(quantile_(high|low)|quantile|deviation)|variables/(mean|deviation)"}
# Columns of tables that have names, which may be "nan"; all others have numbers.
NAMED = {"fastener", "first", "second", "event", "joint", "case", "plate", "direction", "of", "at", "quantity", "unit",
         "check", "formula", "inputs", "largest in case", "smallest in case"}
LONGEST_LINE = 8000  # characters of a message: names of files and places fit, what an input holds of any length does not
EARLIER = b"what was there before"


@cache
def documented(kind):
    """Patterns of the paths of datasets that may be infinite, and of those that may be NaN, by the page of their kind."""
    infinite, nan = [INFINITE_TOO.get(kind, "$")], ["$"]
    for line in (ROOT / "schemas" / PAGES[kind]).read_text().splitlines():
        cells = line.split("|")
        if len(cells) < 7 or "float64" not in cells[2]:
            continue
        path = re.sub(r"<[^>]*>", "[^/]+", cells[1].strip(" `"))
        infinite += [path] if "infinite" in cells[5] else []
        nan += [path] if "NaN" in cells[5] else []
    return re.compile("|".join(infinite)), re.compile("|".join(nan))


def check_numbers(kind, file, name, values):
    """Raises Fall for a number of a dataset that the page of its kind of file does not allow."""
    infinite, nan = documented(kind)
    if np.isnan(values).any() and not nan.fullmatch(name):
        raise Fall(f"{file}:{name} holds NaN")
    if np.isinf(values).any() and not infinite.fullmatch(name):
        raise Fall(f"{file}:{name} holds an infinite number")


def check_hdf5(path):
    """The same for all datasets of a file; NaN of a study is a sample that was not solved."""
    with h5py.File(path) as file:
        kind = file.attrs["format"]

        def visit(name, item):
            if not isinstance(item, h5py.Dataset) or item.dtype.kind != "f":
                return
            values = item[()]
            check_numbers(kind, path.name, name, values)
            if kind == "study-result" and np.isnan(values).any() and not (file["samples/status"][()] != 0).any():
                raise Fall(f"{path.name}:{name} holds NaN, though all samples are solved")

        file.visititems(visit)
        return kind, dict(file.attrs)


def check_written(path):
    """The same for any file that a program writes, by its ending."""
    if path.suffix == ".h5":
        return check_hdf5(path)
    if path.stat().st_size == 0:
        raise Fall(f"{path.name} is empty")
    if path.suffix == ".csv":
        check_table(path)
    elif path.suffix == ".vtu" and re.search(rb"(?<![\w\"/])-?nan(?![\w\"/])", path.read_bytes(), re.I):
        raise Fall(f"{path.name} holds NaN")
    return None, {}


def check_table(path):
    """Raises Fall for a NaN in a table, or a line with other cells than its heading."""
    csv.field_size_limit(sys.maxsize)  # names may be long
    with open(path, encoding="utf-8", errors="surrogateescape", newline="") as file:
        heading, *lines = csv.reader(file)
    for number, cells in enumerate(lines, 2):
        if len(cells) != len(heading):
            raise Fall(f"{path.name}: row {number} has {len(cells)} cells, its heading {len(heading)}")
        for name, cell in zip(heading, cells):
            if name not in NAMED and "nan" in cell.lower():
                raise Fall(f"{path.name}: row {number}, {name}: {cell}")


class Folder:
    """What stands in a folder before a run, against which it is held afterwards."""

    def __init__(self, folder, output, earlier):
        """With `earlier` a file stands at the output already, which a failure must not touch."""
        self.folder, self.output = folder, folder / output
        self.output.unlink(missing_ok=True)
        if earlier:
            self.output.write_bytes(EARLIER)
        self.before, self.earlier = self._names(), earlier

    def _names(self):
        return {path.name for path in self.folder.iterdir()}

    def check(self, outcome, others=(), writes=True):
        """`others` are names that the run may also leave: tables, and blocks of a study. A slice of a study leaves its
        blocks, and not `writes` the output."""
        new = self._names() - self.before - set(others) - {self.output.name}
        if new:
            raise Fall(f"exit status {outcome.status} left {', '.join(sorted(new))}")
        for path in (self.folder / name for name in others):
            if path.is_file():
                check_written(path)
        kept = self.earlier and self.output.exists() and self.output.read_bytes() == EARLIER
        if outcome.status == 0 and writes:
            if kept or not self.output.exists():
                raise Fall("exit status 0 without an output")
            return check_written(self.output)
        if self.earlier and not self.output.exists():
            raise Fall(f"exit status {outcome.status} removed the earlier output")
        if self.output.exists() and not kept:
            self._check_incomplete(outcome)
        return None, {}

    def _check_incomplete(self, outcome):
        """What a joint has converged of is kept with status 4, and says that it is not complete."""
        if outcome.status != 4:
            raise Fall(f"exit status {outcome.status} wrote {self.output.name}")
        kind, attributes = check_written(self.output)
        if kind != "joint-result" or attributes["complete"] != 0:
            raise Fall(f"exit status 4 wrote {self.output.name}, which does not say that it is incomplete")


def check_words(outcome, names):
    """A refusal is one line, the last, and names one of the files or an option; no line is as long as an input may make it,
    nor does any hold a character that would move a terminal's cursor."""
    lines = outcome.stderr.rstrip("\n").split("\n")
    errors = [line for line in lines if ": error: " in line]
    if len(errors) != (outcome.status != 0):
        raise Fall(f"{len(errors)} lines of errors with exit status {outcome.status}: {str(errors)[:500]}")
    if max(map(len, lines)) > LONGEST_LINE:
        raise Fall(f"a line of {max(map(len, lines))} characters: {max(lines, key=len)[:200]}")
    if re.search("[\x00-\x08\x0b-\x1f\x7f]", outcome.stderr.replace("\r", "")):
        raise Fall(f"a control character in what it says: {outcome.stderr[-1000:]!r}")
    if errors and lines[-1] != errors[0]:
        raise Fall(f"the refusal is not one line: {errors[0][:200]} ... {lines[-1][:200]}")
    if outcome.status in (2, 3) and not any(name in errors[0] for name in [*names, ": error: --"]):
        raise Fall(f"the refusal names no file: {errors[0][:300]}")
