# SPDX-License-Identifier: GPL-3.0-or-later
"""The README says what the programs do: readme_test.py BIN_FOLDER. Options against --help, tables against their script."""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = ("stage1_plate", "stage2_extract", "stage3_nonlinear")
COMMON = {"-h", "--help", "--version", "-o", "--output", "--quiet", "--timings"}


def output(*words):
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout


def options_in_readme(readme, program):
    rows = re.findall(rf"^\| {program} \| (.*?) \|", readme, re.M)
    return {option for row in rows for option in re.findall(r"`(-+[a-z-]+)`", row)}


def check_options(readme):
    for program in PROGRAMS:
        helped = set(re.findall(r"(?<!\w)-{1,2}[a-z][a-z-]*", output(program, "--help").split("Options:")[1])) - COMMON
        assert options_in_readme(readme, program) == helped, (program, helped)
    assert options_in_readme(readme, "all") == COMMON - {"-h"}


def check_names(readme):
    """Laws, formulas and solvers of the schema, with which the programs agree, all have their place."""
    schema = json.loads((ROOT / "schemas/joint.schema.json").read_text())
    laws = {each["properties"]["type"]["const"] for each in schema["definitions"].values()
            if "type" in each.get("properties", {})}
    assert set(re.findall(r"^\| `([a-z ]+)` \|", readme.split("| law | ")[1].split("\n\n")[0], re.M)) == laws, laws
    for row, names in (("formula", schema["definitions"]["formula"]["properties"]["formula"]["enum"]),
                       ("solver", schema["properties"]["solver"]["properties"]["method"]["enum"])):
        shown = re.findall(r"`([^`]+)`", re.search(rf"^\| `{row}` \| (.*) \|$", readme, re.M)[1])
        assert set(names) <= set(shown), (row, names)


def check_joint(readme):
    """The sheet and joint that the README shows are those of the example; its commands run on them."""
    example = ROOT / "examples/lap_joint"
    shown = re.findall(r"```json\n(.*?)```", readme, re.S)
    assert shown == [(example / name).read_text() for name in ("upper.json", "joint.json")]
    commands = re.search(r"```\n(stage1_plate.*?)```", readme, re.S)[1].splitlines()
    with tempfile.TemporaryDirectory() as folder:
        for path in example.glob("*.json"):
            shutil.copy(path, folder)
        for command in commands:
            subprocess.run(command.split(), check=True, cwd=folder, capture_output=True)
        check_what_if(readme, folder)


def check_what_if(readme, folder):
    """Its command, its script and what that prints."""
    command = re.search(r"`(stage3_nonlinear [^`]*--sensitivities)`", readme)[1]
    script, printed = re.search(r"```python\n(.*?)```\n\n```\n(.*?)```", readme, re.S).groups()
    subprocess.run(command.split(), check=True, cwd=folder, capture_output=True)
    result = subprocess.run([sys.executable, "-c", script], check=True, cwd=folder, capture_output=True, text=True)
    assert result.stdout == printed, result.stdout


def check_fit(readme):
    """The fit that the README shows is what its command prints, and it draws."""
    command, printed = re.search(r"```\n(scripts/fit_law [^\n]*)\n```\n```\n(.*?)```", readme, re.S).groups()
    script, *words = command.split()
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(ROOT / "examples/fit", Path(folder) / "examples/fit")
        run = subprocess.run([ROOT / script, *words], check=True, cwd=folder, capture_output=True, text=True)
        assert run.stdout == printed, f"README.md shows another fit than:\n{run.stdout}"
        assert (Path(folder) / words[-1]).stat().st_size > 0


def check_table(readme, name, timed=None):
    """A block of the README is what its script prints, but for a column of times."""
    shown = readme.split(f"<!-- {name} -->\n")[1].split(f"<!-- /{name} -->")[0]
    printed = output(str(ROOT / f"scripts/{name}_table"))

    def rows(text):
        return [[cell for i, cell in enumerate(line.split("|")) if i != timed] for line in text.splitlines()]

    assert rows(shown) == rows(printed), f"README.md is not what scripts/{name}_table prints:\n{printed}"


def check_links(readme):
    for target in re.findall(r"\]\((?!http)([^)]+)\)", readme):
        assert (ROOT / target.split("#")[0]).exists(), f"README.md links to {target}"


def main(folder):
    os.environ["PATH"] = folder + os.pathsep + os.environ["PATH"]
    readme = (ROOT / "README.md").read_text()
    check_links(readme)
    check_options(readme)
    check_names(readme)
    check_joint(readme)
    check_fit(readme)
    check_table(readme, "accuracy")
    check_table(readme, "verification", timed=5)


if __name__ == "__main__":
    main(*sys.argv[1:])
