# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies of examples for tests, in which they may be made."""
import os
import shutil
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MADE = shutil.ignore_patterns("*.h5", "*.vtu", "*.csv", "out", "pictures")


def copy_example(name, folder):
    """The folder of the copy, with the scripts where its Makefile finds them, and its sheets solved where ctest has had them
    solved before (FASTJOINT_SOLVED, by solve_example)."""
    copy = Path(folder) / "examples" / name
    if not (Path(folder) / "scripts").exists():
        shutil.copytree(ROOT / "scripts", Path(folder) / "scripts")
    shutil.copytree(ROOT / "examples" / name, copy, ignore=MADE)
    for file in Path(os.environ.get("FASTJOINT_SOLVED", "/nowhere"), "examples", name).glob("*.h5"):
        (copy / file.name).symlink_to(file)
    return copy
