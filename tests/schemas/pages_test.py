# SPDX-License-Identifier: GPL-3.0-or-later
"""The HDF5 files that the programs write are what schemas/*.md say, dataset by dataset, both ways, meanings included.

usage: pages_test.py BIN_FOLDER
"""
import json
import os
import pathlib
import re
import shutil
import sys
import tempfile

import h5py

from programs import ROOT, Programs, must

TEMPLATES = {"<d>": lambda file: file["p"][:], "<name>": lambda file: file["plate/name"].asstr()[:],
             "<quantity>": lambda file: file["envelope/quantity"].asstr()[:],
             "<kind>": lambda file: [name for name, item in file["statistics"].items() if isinstance(item, h5py.Group)]}
UNITS = {"of force": "force", "of largest_force": "force", "of peak": "force/length^2", "of largest_peak": "force/length^2",
         "of bent_peak": "force/length^2", "of bent_peak_smaller": "force/length^2", "of largest_bent_peak": "force/length^2",
         "of displacement": "length", "of delta": "length", "of external_force": "force", "of transferred_first": "force",
         "of transferred_second": "force", "of F": "force", "of bearing_load": "force", "of bearing_load_y": "force", "of bypass_load": "force",
         "of bypass_error": "force", "of bearing_stress": "force/length^2", "of peak_hoop": "force/length^2", "of peak_error": "force/length^2",
         "of contact_pressure": "force/length^2", "of peak_angle": "deg", "of against_slip": "deg", "of gross_concentration": "1",
         "of net_concentration": "1", "of bearing_concentration": "1", "of net_stress": "force/length^2", "of bypass_stress": "force/length^2", "of bypass_across": "force/length^2", "of bypass_direction": "deg",
         "of net_direction": "deg", "of K_I": "force/length^1.5", "of largest_K_I": "force/length^1.5", "of K_II": "force/length^1.5",
         "of utilisation": "1", "of largest_utilisation": "1"}  # of a study's numbers
JOINT = {
    "format": "joint", "version": 1,
    "plates": {"center": "center.matrices.h5", "doubler": "doubler.matrices.h5"},
    "laws": {"bolt": {"type": "power", "A": 1000, "n": 0.7}, "soft": {"type": "bilinear", "k": 5000, "F_yield": 20, "k_yield": 500}},
    "fasteners": [{"id": "1", "between": ["center:1", "doubler:1"], "law": "bolt", "clearance": 0.001,
                   "friction": 0.1}, {"id": "2", "between": ["center:2", "doubler:2"], "law": "soft"}],
    "cases": [{"name": "pull", "loads": [{"external": "center:P", "force": 100}], "increments": 5}],
    "margins": {"checks": [{"check": "peak", "limit": 1000}]},
}
CRACK = {"from": "hole:1", "angle": 90, "length": 0.1}
STUDY = {"format": "study", "version": 1, "samples": 4, "seed": 1, "outputs": ["peaks", "bending", "displacements", "cracks", "margins"],
         "variables": [{"at": "/laws/bolt/A", "distribution": {"type": "uniform", "from": 900, "to": 1100}}]}


class Page:
    def __init__(self, name):
        self.name = name
        self.text = (ROOT / f"schemas/{name}.md").read_text()
        self.attributes = self.table("attribute")
        self.datasets = self.table("path")
        self.example = re.search(r"```python\n(.*?)```", self.text, re.DOTALL)[1]

    def table(self, first):
        """Rows, as {column: cell}, of the table whose first column has that name."""
        lines = re.search(rf"^\| {first} \|.*\n(\|.*\n?)*", self.text, re.MULTILINE)[0].splitlines()
        head, _, *rows = [[cell.strip().strip("`") for cell in line.strip("|").split("|")] for line in lines]
        return [dict(zip(head, row, strict=True)) for row in rows]

    def rows(self, file):
        """The table of datasets by path, each row that names a <template> once for every value that the file has."""
        rows = self.datasets
        for word, values in TEMPLATES.items():
            rows = [{key: cell.replace(word, str(value)) for key, cell in row.items()}
                    for row in rows for value in (values(file) if word in row["path"] else [word])]
        return {row["path"]: row for row in rows}


def terms(row):
    """The symbols and numbers of each extent: "(np, e+m)" is [["np"], ["e", "m"]]."""
    return [extent.strip().split("+") for extent in row["shape"].strip("()").split(",") if extent]


def type_name(dtype):
    if h5py.check_string_dtype(dtype) == ("utf-8", None):  # of variable length
        return "string"
    return {"<f8": "float64", "<i4": "int32"}.get(dtype.str, dtype.str)


def measured(rows, items):
    """Size of each symbol, from the first extent where it stands alone."""
    sizes = {}
    for path in sorted(rows.keys() & items.keys()):
        for symbols, extent in zip(terms(rows[path]), items[path].shape):
            if len(symbols) == 1:
                sizes.setdefault(symbols[0], int(symbols[0]) if symbols[0].isdigit() else extent)
    return sizes


def compare(rows, items, version):
    """What differs between rows and datasets (or attributes) by name, of which each has .dtype and .shape."""
    yield from (f"{path}: is not on the page" for path in sorted(items.keys() - rows.keys()))
    yield from (f"{path}: is not in the file" for path in sorted(rows.keys() - items.keys()))
    sizes = measured(rows, items)
    for path in sorted(rows.keys() & items.keys()):
        row, item = rows[path], items[path]
        if row["type"] != type_name(item.dtype):
            yield f"{path}: type is {type_name(item.dtype)}, the page says {row['type']}"
        shape = tuple(sum(int(t) if t.isdigit() else sizes[t] for t in extent) for extent in terms(row))
        if shape != item.shape:
            yield f"{path}: shape is {item.shape}, the page says {row['shape']} = {shape}"
        if not [1, 0] <= [int(part) for part in row["since"].split(".")] <= version:
            yield f"{path}: is on the page since {row['since']}, the file is of version {version}"


def begins(meaning, description):
    """Whether the meaning on the page, markdown taken off, is the file's description, alone or followed by more."""
    plain = re.sub(r"`|\\(?=[^A-Za-z0-9\s])", "", meaning)
    return plain == description or plain.startswith((f"{description}; ", f"{description}. "))


def check_attributes(rows, datasets, labels):
    for path in sorted(rows.keys() & datasets.keys()):
        attributes = datasets[path].attrs
        unit = re.sub("length|force", lambda match: labels.get(match[0], match[0]), UNITS.get(rows[path]["unit"], rows[path]["unit"]))
        if attributes.get("unit") != unit:
            yield f"{path}: unit is {attributes.get('unit')}, the page says {unit}"
        if set(attributes) != {"unit", "description"} or not attributes["description"]:
            yield f"{path}: has the attributes {dict(attributes)}"
        elif not begins(rows[path]["meaning"], attributes["description"]):
            yield f"{path}: means '{attributes['description']}', the page says '{rows[path]['meaning']}'"


def check(page, path, labels):
    """Compares one file with its page."""
    with h5py.File(path) as file:
        datasets = {}
        file.visititems(lambda name, item: datasets.update({name: item}) if isinstance(item, h5py.Dataset) else None)
        rows, version = page.rows(file), list(file.attrs["version"])
        problems = list(compare(rows, datasets, version))
        problems += check_attributes(rows, datasets, labels)
        attributes = {name: file.attrs.get_id(name) for name in file.attrs}
        problems += compare({row["attribute"]: row for row in page.attributes}, attributes, version)
        if file.attrs["format"] != page.name or f"version {version[0]}.{version[1]}" not in page.text:
            problems.append(f"is a {file.attrs['format']} of version {version}")
        if json.loads(file.attrs["units"]) != {"length": labels.get("length", ""), "force": labels.get("force", "")}:
            problems.append(f"attribute units is {file.attrs['units']}")
    return [f"{page.name}, {path.name}: {problem}" for problem in problems]


def check_symbols(page):
    for row in page.datasets:
        for symbol in {term for extent in terms(row) for term in extent if not term.isdigit()}:
            if any(word in symbol and word not in row["path"] for word in TEMPLATES):
                yield f"{page.name}: {row['path']}: nothing stands for the template in symbol {symbol}"
            if not re.search(rf"^\|.*`{symbol}`.*\| .*\|$", page.text.split("## Root")[0], re.MULTILINE):
                yield f"{page.name}: {row['path']}: symbol {symbol} is not defined"


def check_notices(page, path, labels):
    """A file that differs from the page must be noticed."""
    changes = {
        "extra dataset": lambda file: file.create_dataset("extra", data=[1.0]),
        "missing dataset": lambda file: file.pop("input"),
        "other unit": lambda file: file["input"].attrs.modify("unit", "m"),
        "no description": lambda file: file["input"].attrs.pop("description"),
        "other description": lambda file: file["input"].attrs.modify("description", "JSON text that this file"),
        "extra attribute": lambda file: file.attrs.create("extra", "text"),
    }
    for what, change in changes.items():
        changed = path.with_name("changed.h5")
        shutil.copy(path, changed)
        with h5py.File(changed, "r+") as file:
            change(file)
        if len(check(page, changed, labels)) != 1:
            yield f"{page.name}: {what}: expected one complaint, got {check(page, changed, labels)}"


def run_plate(programs, source, folder, p):
    """Files of one plate, and the labels of its units."""
    solution, matrices = folder / f"{source.stem}.h5", folder / f"{source.stem}.matrices.h5"
    must(programs.plate(source, solution, p))
    must(programs.matrices(solution, matrices))
    return solution, matrices, json.loads(source.read_text()).get("units", {})


def main():
    programs = Programs(sys.argv[1])
    pages = solution_page, matrices_page, result_page, study_page = [
        Page(name) for name in ("plate-solution", "plate-matrices", "joint-result", "study-result")]
    problems = [problem for page in pages for problem in check_symbols(page)]
    examples, good = ROOT / "examples/three_fasteners", ROOT / "tests/schemas/good"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        cracked = json.loads((examples / "center.json").read_text()) | {"cracks": [CRACK]}
        (folder / "center.json").write_text(json.dumps(cracked))
        for source, p in [(good / "plate_plane_strain.json", "1..3"), (good / "plate_tables.json", "2..3"),
                          (good / "plate_half_holes.json", "2"), (good / "plate_springs.json", "1..2"),
                          (good / "plate_bolt.json", "1..3"), (good / "plate_product.json", "2..3"), (examples / "doubler.json", "1..4"),
                          (folder / "center.json", "1..4")]:
            solution, matrices, labels = run_plate(programs, source, folder, p)
            problems += check(solution_page, solution, labels) + check(matrices_page, matrices, labels)
        (folder / "joint.json").write_text(json.dumps(JOINT))
        result = folder / "joint.h5"
        must(programs.joint(folder / "joint.json", result, "--case", "pull", "--sensitivities", "--rim-stresses", "--distance", "0.01"))
        problems += check(result_page, result, labels)
        (folder / "study.json").write_text(json.dumps(STUDY))
        study = folder / "study.h5"
        must(programs.study(folder / "study.json", study, folder / "joint.json"))
        problems += check(study_page, study, labels)
        os.chdir(folder)
        for page, path, reader_name in zip(pages, (solution, matrices, result, study), ("PLATE.h5", "MATRICES.h5", "RESULT.h5", "STUDY.h5")):
            problems = problems or list(check_notices(page, path, labels))
            path.rename(reader_name)
            exec(page.example, {})
    print("\n".join(problems) or "files and pages agree")
    return bool(problems)


if __name__ == "__main__":
    sys.exit(main())
