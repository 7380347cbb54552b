# SPDX-License-Identifier: GPL-3.0-or-later
"""The small valid scenes that are damaged: those of tests/schemas/good, which have every key of the inputs, at the degrees
up to 3, so that each stage takes a fraction of a second. They are solved once for all rounds of an attack."""
import json
import resource
import shutil
import stat
from contextlib import contextmanager
from dataclasses import dataclass

from bench import ROOT

GOOD = ROOT / "tests/schemas/good"
DEGREES = [1, 3]             # of every plate: three say something of errors, and cost little
STUDIED = "joint_laws.json"  # the joint that the studies vary


@dataclass
class Step:
    """One run of a program, by file names in its folder: its words without the output, the file that it writes, and the
    files that it reads."""
    words: list
    output: str
    reads: list

    def command(self, output=None):
        return [*self.words, "-o", output or self.output]


class SmallScenes:
    """A folder with all inputs and outputs, and the steps that made them, by kind of file that they read.

    `plates`, `joints` and `studies` are names of JSON files. `steps` are, for every kind of HDF5 file that is an input
    ("plate", "matrices", "result", "block"), pairs of a file name and a Step that reads it.
    """

    def __init__(self, bench):
        self.bench, self.folder = bench, bench.folder("small-scenes")
        for path in sorted(GOOD.glob("*")):
            shutil.copy(path, self.folder)
        self.plates = sorted(path.name for path in self.folder.glob("plate_*.json"))
        self.steps = {"plate": [], "matrices": [], "result": [], "block": []}
        for name in self.plates:
            self._solve_plate(name)
        self._write_digest()
        self.joints = sorted(path.name for path in self.folder.glob("joint_*.json"))
        for name in self.joints:
            self._solve_joint(name)
        self.studies = sorted(path.name for path in self.folder.glob("study_*.json"))
        for name in self.studies:
            self._solve_study(name)

    def _do(self, step):
        self.bench.must(*step.command(), cwd=self.folder)
        return step

    def _solve_plate(self, name):
        path, stem = self.folder / name, name[:-5]
        plate = json.loads(path.read_text()) | {"p": DEGREES}
        path.write_text(json.dumps(plate, indent=1))
        self._do(Step(["stage1_plate", name], f"{stem}.h5", [name]))
        extract = self._do(Step(["stage2_extract", f"{stem}.h5"], f"{stem}.matrices.h5", [f"{stem}.h5"]))
        self.steps["plate"].append((f"{stem}.h5", extract))
        spec = self._case(plate)
        if spec:
            field = self._do(Step(["stage2_extract", f"{stem}.h5", "--field", spec], f"{stem}.vtu", [f"{stem}.h5"]))
            self.steps["plate"].append((f"{stem}.h5", field))

    @staticmethod
    def _case(plate):
        """A field that this plate has: of its first external."""
        for external in plate.get("external", []):
            kind = "external" if external["kind"] == "rigid" else "traction"
            return f"{kind}:{external['id']}=0.5"
        return None

    def _write_digest(self):
        """The digest of matrices depends on rounding: what stands for it in the joint gives way to it."""
        seal = (self.folder / "plate_half_holes.matrices.h5").read_bytes()[-17:-1].decode()
        for path in self.folder.glob("joint_*.json"):
            path.write_text(path.read_text().replace("0123456789abcdef", seal))

    def _solve_joint(self, name):
        stem, plates = name[:-5], plates_of(json.loads((self.folder / name).read_text()))
        solve = self._do(Step(["stage3_nonlinear", name], f"{stem}.h5", [name, *plates.values()]))
        for file in sorted(set(plates.values())):
            self.steps["matrices"].append((file, solve))
        for plate, file in plates.items():
            solution = file.replace(".matrices.h5", ".h5")
            words = ["stage2_extract", solution, "--field", f"{stem}.h5", "--plate", plate]
            step = Step(words, f"{stem}.{plate}.vtu", [solution, f"{stem}.h5"])
            self.steps["result"].append((f"{stem}.h5", self._do(step)))
            self.steps["plate"].append((solution, step))

    def _solve_study(self, name):
        stem = name[:-5]
        words = ["stage3_nonlinear", STUDIED, "--study", name]
        self.bench.must(*words, "--slice", "1/1", "-o", f"{stem}.h5", cwd=self.folder)
        shutil.copytree(self.folder / f"{stem}.h5.parts", self.folder / f"{stem}.kept")
        merge = self._do(Step([*words, "--merge"], f"{stem}.h5", [STUDIED, name]))
        shutil.copytree(self.folder / f"{stem}.kept", self.folder / f"{stem}.h5.parts")  # merging has removed it
        for block in sorted((self.folder / f"{stem}.kept").iterdir()):
            self.steps["block"].append((f"{stem}.h5.parts/{block.name}", merge))

    def lay_out(self, folder):
        """Links to all files in the folder of a round; what is damaged there is replaced, so that nothing here changes."""
        for path in self.folder.iterdir():
            if path.is_file():
                (folder / path.name).symlink_to(path)


def limits(bench):
    """A limit of memory, above what a run may hold, under which one that goes mad does not take the machine along; address
    sanitizers reserve more."""
    return [] if bench.sanitized else [(resource.RLIMIT_AS, 6 << 30)]


def plates_of(joint):
    """Names of the plates of a joint with the files of their matrices."""
    return {name: plate["file"] if isinstance(plate, dict) else plate for name, plate in joint["plates"].items()}


def small_scenes(bench):
    """The scenes of this bench, made when first asked for."""
    if not hasattr(bench, "small_scenes"):
        bench.small_scenes = SmallScenes(bench)
    return bench.small_scenes


@contextmanager
def kept_whole(folder, mutant=None):
    """When something falls, what is left in the folder can be kept: links to the scenes become copies, and pipes go.
    `mutant` tells the bytes of a damaged file that a run may have removed."""
    try:
        yield
    except Exception:
        if mutant:
            (folder / "mutant.bytes").write_bytes(mutant())
        for path in list(folder.rglob("*")):
            if stat.S_ISFIFO(path.lstat().st_mode):
                path.unlink()
            elif path.is_symlink() and str(path.readlink()).startswith(str(folder.parent)):
                data = path.read_bytes()
                path.unlink()
                path.write_bytes(data)
        raise
