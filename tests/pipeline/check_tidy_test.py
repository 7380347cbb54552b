# SPDX-License-Identifier: GPL-3.0-or-later
"""Which files scripts/check/check_tidy reads, in a repository of empty ones with tools that only say their last word: check_tidy_test.py."""
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "scripts/check/check_tidy"
FILES = ("common/h5/reader.cpp", "common/h5/reader.hpp", "common/input/value.cpp", "common/formats/header.cpp",
         "common/program/program.cpp", "common/pfem/mesh.cpp", "common/pfem/mesh.hpp", "common/errors.hpp",
         "stage1_plate/scene/scene.cpp", "stage2_extract/extract.cpp", "stage3_nonlinear/scene/scene.cpp",
         "stage3_nonlinear/laws/law.cpp", "tests/some_test.cpp")
READING = {each for each in FILES if each.endswith(".cpp")} - {"common/pfem/mesh.cpp", "stage2_extract/extract.cpp",
                                                               "tests/some_test.cpp"}


class Repository:
    def __init__(self, folder):
        self.folder = folder
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")} | {
            "PATH": f"{folder}/tools{os.pathsep}{os.environ['PATH']}", "HOME": str(folder),
            "GIT_CONFIG_GLOBAL": "/dev/null", "GIT_CONFIG_SYSTEM": "/dev/null"}

    def run(self, *words):
        return subprocess.run(words, cwd=self.folder, env=self.environment, capture_output=True, text=True)

    def git(self, *words):
        result = self.run("git", "-c", "user.name=n", "-c", "user.email=e", *words)
        assert result.returncode == 0, result

    def commit(self, *changed):
        for name in changed:
            path = self.folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(path.read_text() + "\n" if path.exists() else "")
        self.git("add", "-A")
        self.git("commit", "-q", "--allow-empty", "-m", "more")

    def read(self, *words):
        result = self.run("scripts/check/check_tidy", *words)
        assert result.returncode == 0, result
        return {line for line in result.stdout.splitlines() if line.endswith("pp")}


def make(folder):
    (folder / "scripts/check").mkdir(parents=True)
    shutil.copy(SCRIPT, folder / "scripts/check")
    (folder / "tools").mkdir()
    for name, does in (("cmake", ":"), ("clang-tidy-16", 'echo "${!#}"')):
        (folder / "tools" / name).write_text(f"#!/usr/bin/env bash\n{does}\n")
        (folder / "tools" / name).chmod(0o755)
    repository = Repository(folder)
    repository.git("init", "-q", "-b", "main")
    repository.commit(*FILES)
    return repository


def main():
    with tempfile.TemporaryDirectory() as name:
        repository = make(Path(name).resolve())
        assert repository.read() == READING
        assert repository.read("all") == {each for each in FILES if each.endswith(".cpp")} - {"tests/some_test.cpp"}
        assert repository.read("changed") == READING, "without history"

        missing = repository.run("scripts/check/check_tidy", "common/pfem/*.cpp", "stage3_nonlinear/laws/read_*.cpp")
        assert missing.returncode == 2 and "stage3_nonlinear/laws/read_*.cpp matches no file" in missing.stderr, missing
        assert not missing.stdout

        repository.commit("common/input/value.cpp")
        repository.commit("stage2_extract/extract.cpp")
        for _ in range(3):
            repository.commit()
        assert repository.read("changed") == {"common/input/value.cpp", "stage2_extract/extract.cpp"}, "of five commits"
        repository.commit("tests/some_test.cpp")
        assert repository.read("changed") == {"stage2_extract/extract.cpp"}
        repository.git("update-ref", "refs/remotes/origin/main", "HEAD")
        repository.commit("common/pfem/mesh.hpp", "common/errors.hpp")
        assert repository.read("changed") == {"common/pfem/mesh.cpp"}, "since the branch left that of origin"
        (Path(name) / "stage1_plate/scene/scene.cpp").write_text("int i;\n")
        assert repository.read("changed") == {"common/pfem/mesh.cpp", "stage1_plate/scene/scene.cpp"}
        repository.git("update-ref", "refs/remotes/origin/main", "HEAD~2")
        repository.git("checkout", "-q", "--", ".")
        repository.git("reset", "-q", "--hard", "HEAD~1")
        assert repository.read("changed") == set(), "only a test has changed"


if __name__ == "__main__":
    main()
