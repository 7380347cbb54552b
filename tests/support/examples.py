# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies of examples for tests, in which they may be made."""
import fcntl
import hashlib
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MADE = shutil.ignore_patterns("*.h5", "*.vtu", "*.csv", "out", "pictures")
SHARED = {"lap_joint", "splice", "butt_joint"}  # whose sheets several tests start from


def solved(scene):
    """Folder with NAME.h5 and NAME.matrices.h5 of NAME.json, solved once by the same programs (the test's first argument)."""
    programs = Path(sys.argv[1]).resolve()
    commands = [[programs / "stage1_plate", scene.name, "-o", f"{scene.stem}.h5"],
                [programs / "stage2_extract", f"{scene.stem}.h5", "-o", f"{scene.stem}.matrices.h5"]]
    text = b"".join([*(Path(command[0]).read_bytes() for command in commands), scene.read_bytes()])
    folder = programs.parent / "solved" / f"{scene.stem}-{hashlib.sha256(text).hexdigest()[:16]}"
    folder.parent.mkdir(exist_ok=True)
    with open(f"{folder}.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not folder.exists():
            with tempfile.TemporaryDirectory(dir=folder.parent) as name:
                shutil.copy(scene, name)
                for command in commands:
                    subprocess.run([*command, "--quiet"], cwd=name, check=True)
                shutil.copytree(name, folder)
    return folder


def copy_example(name, folder):
    """The folder of the copy, with the scripts where its Makefile finds them, and the sheets of SHARED examples solved."""
    copy = Path(folder) / "examples" / name
    if not (Path(folder) / "scripts").exists():
        shutil.copytree(ROOT / "scripts", Path(folder) / "scripts")
    shutil.copytree(ROOT / "examples" / name, copy, ignore=MADE)
    for scene in copy.glob("*.json") if name in SHARED else ():
        if '"format": "plate"' in scene.read_text():
            for file in solved(scene).glob("*.h5"):
                (copy / file.name).symlink_to(file)
    return copy
