# SPDX-License-Identifier: GPL-3.0-or-later
"""README.md and docs/ say what the programs do: readme_test.py BIN_FOLDER. Options against --help, tables against their script."""
import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
sys.dont_write_bytecode = True
from examples import copy_example  # noqa: E402

PROGRAMS = ("stage1_plate", "stage2_extract", "stage3_nonlinear")
COMMON = {"-h", "--help", "--version", "-o", "--output", "--quiet", "--timings"}


def output(*words):
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout


def page(name):
    return (ROOT / name).read_text()


def options_of(programs, program):
    rows = re.findall(rf"^\| {program} \| (.*?) \|", programs, re.M)
    return {option for row in rows for option in re.findall(r"`(-+[a-z-]+)`", row)}


def check_options(programs):
    for program in PROGRAMS:
        helped = set(re.findall(r"(?<!\w)-{1,2}[a-z][a-z-]*", output(program, "--help").split("Options:")[1])) - COMMON
        assert options_of(programs, program) == helped, (program, helped)
    assert options_of(programs, "all") == COMMON - {"-h"}


def check_names(laws_page, solvers_page):
    """Laws, formulas and solvers of the schema, with which the programs agree, all have their place."""
    schema = json.loads(page("schemas/joint.schema.json"))
    laws = {each["properties"]["type"]["const"] for each in schema["definitions"].values()
            if "type" in each.get("properties", {})}

    def first_column(table):
        rows = laws_page.split(table)[1].split("\n\n")[0].splitlines()[1:]
        return [name for row in rows for name in re.findall(r"`([^`]+)`", row.split("|")[1])]

    assert set(first_column("| law |")) == laws, laws
    formulas = schema["definitions"]["formula"]["properties"]["formula"]["enum"]
    assert sorted(first_column("| `formula` | C |")) == sorted(formulas), formulas
    shown = re.findall(r"`([^`]+)`", re.search(r"^\| `solver` \| (.*) \|$", solvers_page, re.M)[1])
    assert set(schema["properties"]["solver"]["properties"]["method"]["enum"]) <= set(shown), shown


def commands_of(text):
    return re.search(r"```\n(stage1_plate.*?)```", text, re.S)[1].splitlines()


def has_been_run(command, folder):
    """True of what has solved the sheet that lies there."""
    sheet = Path(command.split()[1]).stem
    return command in (f"stage1_plate {sheet}.json -o {sheet}.h5", f"stage2_extract {sheet}.h5 -o {sheet}.matrices.h5") and \
        (folder / command.split()[-1]).exists()


def run_example(example, text, then):
    """The commands of a page, in a copy of an example, and what then is to be looked at there."""
    with tempfile.TemporaryDirectory() as name:
        is_solved = example.parent.name == "examples"
        folder = copy_example(example.name, name) if is_solved else shutil.copytree(example, Path(name) / "scenes")
        for command in commands_of(text):
            if not has_been_run(command, folder):
                subprocess.run(command.split(), check=True, cwd=folder, capture_output=True)
        then(folder)


def check_two_bolts(readme):
    """The README shows the files of its joint whole, and its command prints the lines that it shows and draws."""
    example = ROOT / "examples/two_bolts"
    assert re.findall(r"```json\n(.*?)```", readme, re.S) == [(example / f"{name}.json").read_text() for name in ("upper", "lower", "joint")]
    command = re.search(r"```\n(scripts/run_joint (\S+))\n```", readme)[1].split()
    lines = re.search(r"```\n(  fastener .*?)```", readme, re.S)[1].splitlines()
    with tempfile.TemporaryDirectory() as name:
        folder = copy_example("two_bolts", name)
        printed = subprocess.run(command, check=True, cwd=name, capture_output=True, text=True)
        assert "warning" not in printed.stderr, printed.stderr
        missing = [line for line in lines if line not in printed.stdout.splitlines()]
        assert len(lines) == 9 and not missing, f"README.md shows what is not printed: {missing}"
        assert (folder / "joint.png").stat().st_size > 50_000 and (folder / "joint.csv").exists()
        with h5py.File(folder / "joint.h5") as f:
            rim = f["plates/upper/rim"]
            peak, error = rim["peak_hoop"][-1, 0], rim["peak_error"][-1, 0]
            bent = {f"{name}:{hole}": its for name in ("upper", "lower")
                    for hole, its in zip(f[f"plates/{name}/rim/hole"].asstr(), f[f"plates/{name}/bending/peak"][-1])}
            worst = max(bent, key=bent.get)
        assert f"it is {bent[worst]:.0f} N/mm² at {worst}." in readme, bent
        assert f"The highest stress in the plane is at hole upper:1, {peak:.1f} +- {error:.1f} N/mm²" in readme, (peak, error)
        check_run_joint(folder, command[0])


def check_butt_joint():
    """What its page shows is printed; no more than 8 kN of each bolt is its collapse load."""
    text = page("examples/butt_joint/README.md")
    shown = [line for block in re.findall(r"```\n((?:  |the |increment ).*?)```", text, re.S) for line in block.splitlines()]
    with tempfile.TemporaryDirectory() as name:
        folder = copy_example("butt_joint", name)
        printed = subprocess.run(["scripts/run_joint", "examples/butt_joint/joint.json", "--no-picture"], check=True, cwd=name, capture_output=True, text=True)
        command, with_cases = re.findall(r"```\n(stage3_nonlinear [^\n]*)\n```", text)
        collapse = subprocess.run(command.split(), cwd=folder, capture_output=True, text=True)
        cases = subprocess.run(with_cases.split(), cwd=folder, check=True, capture_output=True, text=True)
    assert collapse.returncode == 4 and "load factor 0.8 is an upper bound of the limit load" in collapse.stderr, collapse
    lines = [line.split(", residual")[0] for line in (printed.stdout + collapse.stdout + cases.stdout).splitlines()]  # residuals are rounding
    missing = [line for line in shown if line.split(", residual")[0] not in lines]
    assert len(shown) == 17 and not missing, f"examples/butt_joint/README.md shows what is not printed: {missing}"


def check_run_joint(folder, script):
    """Nothing is solved twice; a sheet that changes is solved again, and no other; what fails says so and ends."""
    def run(*words, status=0):
        done = subprocess.run([ROOT / script, *words], cwd=folder, capture_output=True, text=True)
        assert done.returncode == status, done
        return done.stderr if status else [line[2:].split()[:2] for line in done.stdout.splitlines() if line.startswith("$ ")]

    assert [words[0] for words in run("joint.json", "--no-picture")] == ["stage3_nonlinear"]
    sheet = folder / "lower.json"
    before = sheet.read_text()
    sheet.write_text("// thicker\n" + sheet.read_text().replace('"thickness": 2', '"thickness": 3'))
    assert run("joint.json", "--no-picture", "--p", "7") == [["stage1_plate", "lower.json"], ["stage2_extract", "lower.h5"], ["stage3_nonlinear", "joint.json"]]
    for text in (before, "// thin\n" + before):  # older than the matrices, as a file copied back with its time
        sheet.write_text(text)
        os.utime(sheet, (0, 0))
        assert run("joint.json", "--no-picture")[:2] == [["stage1_plate", "lower.json"], ["stage2_extract", "lower.h5"]]
        assert run("joint.json", "--no-picture") == [["stage3_nonlinear", "joint.json"]]
    sheet.write_text(sheet.read_text().replace('"thickness": 2', '"thickness": -3'))
    assert "lower.json: /geometry/grid/thickness" in run("joint.json", status=2)
    sheet.rename(folder / "gone.json")
    assert [words[0] for words in run("joint.json", "--no-picture")] == ["stage3_nonlinear"], "matrices without a sheet are taken as they are"
    (folder / "lower.matrices.h5").unlink()
    assert "lower.matrices.h5 is not there, and neither is lower.json to make it from" in run("joint.json", status=2)
    for text, message in (("{", "cannot be read"), ("[]", "/plates: is missing"), ('{"plates": {"a": 1}}', "/plates/a: is 1; allowed: the path")):
        (folder / "bad.json").write_text(text)
        assert f"bad.json: {message}" in run("bad.json", status=2), text


def check_columns(path, two_directions):
    """The table of columns has those of the CSV in their order; those of components where discs move along x and y."""
    rows = page("docs/results.md").split("| column | what |\n|---|---|\n")[1].split("\n\n")[0].splitlines()
    told = [name for row in rows for name in re.findall(r"`(\w+)`", row.split("|")[1])]
    components = {"delta_x", "delta_y", "F_x", "F_y"}
    with path.open() as file:
        heads = [head.split(" [")[0] for head in next(csv.reader(file))]
    assert heads == [name for name in told if two_directions or name not in components], (heads, told)


def check_lap_joint(programs, results):
    def look(folder):
        check_columns(Path(folder, "joint.csv"), two_directions=True)
        check_what_if(results, folder)

    run_example(ROOT / "examples/lap_joint", programs, look)
    run_example(ROOT / "tests/pipeline/scenes/lap_joint", programs,
                lambda folder: check_columns(Path(folder, "joint.csv"), two_directions=False))


def check_what_if(results, folder):
    """Its command, its scripts, of which each goes on where the one before ended, and what they print."""
    command = re.search(r"`(stage3_nonlinear [^`]*--sensitivities)`", results)[1]
    scripts, printed = zip(*re.findall(r"```python\n(.*?)```\n\n```\n(.*?)```", results, re.S))
    assert len(scripts) == 2, scripts
    subprocess.run(command.split(), check=True, cwd=folder, capture_output=True)
    result = subprocess.run([sys.executable, "-c", "".join(scripts)], check=True, cwd=folder, capture_output=True, text=True)
    assert result.stdout == "".join(printed), result.stdout


def rows_below(text, head):
    return [[cell.strip() for cell in row.strip("|").split("|")] for row in text.split(head)[1].split("\n\n")[0].splitlines()[2:]]


def check_numbers(readme, verification, performance):
    """Numbers that the README has of other pages stand there."""
    elsewhere = verification + page("examples/ladder/README.md")
    numbers = [number for row in rows_below(readme, "\n## How good\n\n") for cell in row[1:3]
               for number in re.findall(r"^\[?([\d.]+(?:e-\d+)?)", cell)]
    assert len(numbers) == 9, numbers
    for number in numbers:
        assert re.search(rf"[| ]{re.escape(number)} ", elsewhere), f"README.md has {number}, which is nowhere else"
    timed = rows_below(readme, "by `scripts/measure/time_panels`; [more](docs/performance.md):\n\n")
    measured = {row.split(" | ")[0].strip("| "): row.split(" | ")[1:3] for row in performance.splitlines() if row.startswith("| ")}
    assert len(timed) == 3 and not any("loads only" in name for name, *_ in timed), "default settings come first"
    for name, seconds, memory in timed:
        run = name.split(": ")[-1]
        assert [seconds, memory] == [cell.strip() for cell in measured[run]], (name, measured[run])


def check_fit(laws):
    """The fit that the page shows is what its command prints, and it draws."""
    command, printed = re.search(r"```\n(scripts/fit_law [^\n]*)\n```\n```\n(.*?)```", laws, re.S).groups()
    script, *words = command.split()
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(ROOT / "examples/fit", Path(folder) / "examples/fit")
        run = subprocess.run([ROOT / script, *words], check=True, cwd=folder, capture_output=True, text=True)
        assert run.stdout == printed, f"docs/laws.md shows another fit than:\n{run.stdout}"
        assert (Path(folder) / words[-1]).stat().st_size > 0


def check_table(text, name, timed=None):
    """A block of a page is what its script prints, but for a column of times."""
    shown = text.split(f"<!-- {name} -->\n")[1].split(f"<!-- /{name} -->")[0]
    printed = output(str(ROOT / f"scripts/measure/{name}_table"))

    def rows(lines):
        return [[cell for i, cell in enumerate(line.split("|")) if i != timed] for line in lines.splitlines()]

    assert rows(shown) == rows(printed), f"docs/verification.md is not what scripts/measure/{name}_table prints:\n{printed}"


def anchors(path):
    headings = re.findall(r"^#+ (.*)$", path.read_text(), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def check_links(path):
    for target in re.findall(r"\]\((?!http)([^)]+)\)", path.read_text()):
        name, _, anchor = target.partition("#")
        found = path.parent / name if name else path
        assert found.exists(), f"{path} links to {target}"
        assert not anchor or anchor in anchors(found), f"{path} links to {target}, which has no such heading"


def main(folder):
    os.environ["PATH"] = folder + os.pathsep + os.environ["PATH"]
    readme = page("README.md")
    assert readme.count("\n") <= 120, "README.md is a front door"
    for path in [ROOT / "README.md", *(ROOT / "docs").glob("*.md"), *(ROOT / "examples").glob("*/README.md")]:
        check_links(path)
    programs, verification = page("docs/programs.md"), page("docs/verification.md")
    check_options(programs)
    check_names(page("docs/laws.md"), page("docs/solvers.md"))
    check_numbers(readme, verification, page("docs/performance.md"))
    check_two_bolts(readme)
    check_butt_joint()
    check_lap_joint(programs, page("docs/results.md"))
    check_fit(page("docs/laws.md"))
    check_table(verification, "accuracy")
    check_table(verification, "verification", timed=5)


if __name__ == "__main__":
    main(*sys.argv[1:])
