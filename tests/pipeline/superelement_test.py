# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/superelement: a reader that knows only Nastran's card format assembles its cards, solves them, and finds the
displacements and forces of stage 3: superelement_test.py BIN_FOLDER."""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
from scripts import run_script  # noqa: E402

SCENES = Path(__file__).resolve().parent / "scenes/lap_joint"
FORCES = {"upper:P": 4000.0, "upper:T": -700.0}


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def set_up():
    """The lap joint with linear laws, discs that move along x and y, a sheet with a rigid edge and a traction, a ground spring."""
    for name in "upper", "lower":
        sheet = json.loads((SCENES / f"{name}.json").read_text())
        del sheet["disc_directions"]
        if name == "upper":
            sheet["external"].append({"id": "T", "on": "top", "direction": "y", "kind": "traction"})
        Path(f"{name}.json").write_text(json.dumps(sheet))
        run("stage1_plate", f"{name}.json", "-o", f"{name}.h5")
        run("stage2_extract", f"{name}.h5", "-o", f"{name}.matrices.h5")
    joint = json.loads((SCENES / "joint.json").read_text())
    joint |= {"laws": {"soft": {"type": "linear", "k": 9000}, "stiff": {"type": "linear", "k": 31234.56789}}, "increments": 1,
              "loads": [{"external": external, "force": force} for external, force in FORCES.items()],
              "fasteners": [{"id": id, "between": [f"upper:{id}", f"lower:{id}"], "law": law} for id, law in zip("abc", ("soft", "stiff", "stiff"))] +
                           [{"id": "d", "between": ["upper:d", "ground"], "law": "soft"}]}
    Path("joint.json").write_text(json.dumps(joint))
    return joint


def real(text):
    """A real of Nastran: an exponent after D, E, or a sign alone."""
    text = text.strip().upper().replace("D", "E")
    for sign in "+-":
        at = text.rfind(sign)
        if at > 0 and text[at - 1] != "E":
            text = text[:at] + "E" + text[at:]
    return float(text)


def read_cards(path):
    """Name and fields of each card, small and large fields alike; names of discs, externals and load sets from comments."""
    cards, comments = [], []
    for line in Path(path).read_text().splitlines():
        assert len(line) <= 80, line
        if line.startswith("$"):
            comments.append(line[2:])
            continue
        head, width = line[:8].strip(), 16 if "*" in line[:8] else 8
        fields = [line[8 + i * width:8 + (i + 1) * width].strip() for i in range(64 // width)]
        if head.strip("*"):
            cards.append((head.strip("*"), fields, comments[-1] if comments else ""))
        else:
            cards[-1][1].extend(fields)
    return cards


def solve(path):
    """Displacements of the points of a file under FORCES, by their names and components, and its points."""
    rows, K, loads, names = {}, {}, {}, {}

    def row(point, component):
        return rows.setdefault((int(point), int(component or 0)), len(rows))

    def add(a, b, value):
        K[a, b] = K.get((a, b), 0) + value
    for card, fields, comment in read_cards(path):
        if card in ("GRID", "SPOINT"):
            names[int(fields[0])] = comment.split(" ", 1)[1]
            if card == "GRID":
                assert set("3456") <= set(fields[6]) and fields[5] == "", fields
        elif card == "DMIG" and fields[1] == "0":
            assert fields[2:5] == ["6", "2", "0"], fields
        elif card == "DMIG":
            column = row(fields[1], fields[2])
            for i in range(4, len(fields), 4):
                if fields[i]:
                    other, value = row(fields[i], fields[i + 1]), real(fields[i + 2])
                    add(column, other, value)
                    if other != column:
                        add(other, column, value)
        elif card == "CELAS2":
            k, ends = real(fields[1]), [row(*fields[i:i + 2]) for i in range(2, len(fields), 2) if fields[i]]
            for a in ends:
                for b in ends:
                    add(a, b, k if a == b else -k)
        elif card in ("FORCE", "SLOAD"):
            traction = comment.rsplit(" ", 1)[1]
            if card == "SLOAD":
                parts = [(row(fields[1], 0), real(fields[2]))]
            else:
                parts = [(row(fields[1], c), real(fields[3]) * real(fields[3 + c])) for c in (1, 2) if real(fields[3 + c])]
            for at, value in parts:
                loads[at] = loads.get(at, 0) + value * FORCES[traction]
        else:
            raise AssertionError(card)
    A, f = np.zeros((len(rows), len(rows))), np.zeros(len(rows))
    for (a, b), value in K.items():
        A[a, b] = value
    for at, value in loads.items():
        f[at] += value
    for (point, component), at in rows.items():
        if component == 0:
            f[at] += FORCES[names[point]]
    u = np.linalg.solve(A, f)
    return {(names[point], component): u[at] for (point, component), at in rows.items()}


def check_against_stage3(joint):
    done = run_script("superelement", "joint.json", "-o", "joint.bdf", "--first", 101)
    assert done.returncode == 0 and "17 unknowns, 8 springs" in done.stdout, done
    u = solve("joint.bdf")
    run("stage3_nonlinear", "joint.json", "-o", "joint.h5")
    with h5py.File("joint.h5") as f:
        largest = max(np.abs(f[f"plates/{sheet}/D"][-1]).max() for sheet in ("upper", "lower"))
        for sheet in "upper", "lower":
            its = f[f"plates/{sheet}"]
            for hole, direction, D in zip(its["disc/hole"].asstr(), its["disc/direction"].asstr(), its["D"][-1]):
                assert abs(u[f"{sheet}:{hole}", "xy".index(direction) + 1] - D) < 1e-8 * largest, (sheet, hole, direction)
        assert abs(u["upper:P", 0] - f["plates/upper/De"][-1, 0]) < 1e-8 * largest
        for i, fastener in enumerate(joint["fasteners"]):
            (first, second), k = fastener["between"], joint["laws"][fastener["law"]]["k"]
            force = [k * (u[first, c] - (0 if second == "ground" else u[second, c])) for c in (1, 2)]
            assert np.allclose(f["F_vector"][-1].reshape(-1, 2)[i], force, rtol=0, atol=1e-7 * FORCES["upper:P"]), fastener


def check_refusals(joint):
    """What has no constant stiffness is named or refused."""
    joint["laws"]["soft"] = {"type": "power", "A": 9000, "n": 0.8}
    joint["fasteners"][1]["clearance"] = 0.01
    Path("power.json").write_text(json.dumps(joint))
    done = run_script("superelement", "power.json", "-o", "power.bdf")
    assert "2 springs; without springs: a, b, d" in done.stdout, done
    assert "fastener d" in Path("power.bdf").read_text().splitlines()[-1]
    sheet = json.loads(Path("upper.json").read_text())
    sheet["holes"][0]["spring"]["compression_only"] = True
    Path("contact.json").write_text(json.dumps(sheet))
    run("stage1_plate", "contact.json", "-o", "contact.h5")
    run("stage2_extract", "contact.h5", "-o", "contact.matrices.h5")
    for plate, options, words in (("contact.matrices.h5", [], "has holes in contact"), ("none.h5", [], "none.h5: cannot be read"),
                                  ("upper.matrices.h5", ["--p", 9], "--p 9:")):
        Path("bad.json").write_text(json.dumps(joint | {"plates": {"upper": plate, "lower": "lower.matrices.h5"}}))
        done = run_script("superelement", "bad.json", "-o", "bad.bdf", *options)
        assert done.returncode == 2 and words in done.stderr and not Path("bad.bdf").exists(), done


def main():
    os.environ["PATH"] = f"{Path(sys.argv[1]).resolve()}:{os.environ['PATH']}"
    sys.path.insert(0, str(ROOT / "scripts/python"))
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        joint = set_up()
        check_against_stage3(joint)
        check_refusals(joint)
        os.chdir("/")


main()
