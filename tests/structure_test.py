#!/usr/bin/env python3
"""Includes go one way: every folder of the product includes only those that its line here names."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]

# Folder: what of its own stage (the flow, in order), then what of common it may include.
STAGES = {
    "stage1_plate": {
        "scene": ["input", "pfem", "rim", ""],
        "mesh": ["pfem", "rim", ""],
        "problem": ["pfem", "plate", "rim", ""],
        "run": ["formats", "linalg", "matrices", "pfem", "plate", "program", "rim", ""],
        "": ["linalg", "program"],
    },
    "stage2_extract": {
        "matrices": ["formats", "matrices", "pfem", ""],
        "field": ["formats", "pfem", "plate", "program", ""],
        "": ["formats", "h5", "matrices", "program", ""],
    },
    "stage3_nonlinear": {
        "laws": ["input", "program", ""],
        "scene": ["input", "program", ""],
        "model": ["formats", "matrices", "rim", ""],
        "strength": ["columns", "formats", "program", "rim", ""],
        "interfaces": ["matrices", "rim", ""],
        "solvers": [],
        "equations": ["matrices", "rim", ""],
        "path": ["program"],
        "results": ["columns", "formats", "matrices", "rim", ""],
        "output": ["columns", "formats", "program", ""],
        "study": ["formats", "h5", "input", "linalg", "program", ""],
        "": ["h5", "input", "linalg", "program", ""],
    },
}
COMMON = {
    "": [],
    "input": [""],
    "linalg": [""],
    "matrices": [""],
    "pfem": ["", "linalg", "matrices"],
    "rim": ["", "matrices", "pfem"],
    "plate": ["", "linalg", "pfem", "rim"],
    "h5": [""],
    "columns": ["", "h5"],
    "formats": ["", "columns", "h5", "matrices", "pfem", "rim"],
    "program": ["", "h5", "linalg"],
}
# Of finite elements the third stage knows the angles, waves and closed forms of a rim alone; of formats those without a mesh; of linear algebra
# nothing that takes CHOLMOD.
THIRD_STAGE_MAY_NOT = ("common/pfem", "common/linalg/cholesky.hpp", "common/linalg/condensed.hpp", "common/plate/",
                       "common/rim/rim.hpp", "common/formats/plate_solution")


def folder_of(path):
    parts = path.split("/")
    return parts[0], "/".join(parts[1:-1])


def allowed(top, folder):
    if top == "common":
        return {("common", each) for each in COMMON[folder]} | {(top, folder)}
    flow = list(STAGES[top])
    earlier = {(top, each) for each in flow[:flow.index(folder) + 1]}
    return earlier | {("common", each) for each in STAGES[top][folder]}


def problems():
    seen = set()
    for path in sorted(each for top in ("common", *STAGES) for each in (ROOT / top).rglob("*.[ch]pp")):
        name = path.relative_to(ROOT).as_posix()
        top, folder = folder_of(name)
        seen.add((top, folder))
        if folder not in (COMMON if top == "common" else STAGES[top]):
            yield f"{name}: its folder is not in the table of this test"
            continue
        for included in re.findall(r'^#include "([^"]+)"', path.read_text(), re.M):
            if folder_of(included) not in allowed(top, folder):
                yield f"{name}: may not include {included}"
            if top == "stage3_nonlinear" and included.startswith(THIRD_STAGE_MAY_NOT):
                yield f"{name}: includes finite elements, {included}"
    for top, folders in (("common", COMMON), *STAGES.items()):
        yield from (f"{top}/{folder}: is in the table of this test, but empty" for folder in folders
                    if (top, folder) not in seen)


if __name__ == "__main__":
    found = list(problems())
    print("\n".join(found) or "every include goes with the flow")
    sys.exit(bool(found))
