# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/ and code agree: docs_test.py. Sections that comments cite, files, paths and names that documents mention are there,
codes of warnings are in their table."""
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CODE = [path for folder in ("common", "scripts", "stage1_plate", "stage2_extract", "stage3_nonlinear", "tests")
        for path in (ROOT / folder).rglob("*")
        if path.suffix in (".cpp", ".hpp", ".py")
        or (folder == "scripts" and path.is_file() and path.parent.name != "__pycache__")]


def cited_sections(text):
    """Numbers after "docs/theory.md, section(s)" in comments, which may go on in the next line."""
    comments = re.sub(r"\n\s*(///?|#)?\s*", " ", text)
    for numbers in re.findall(r"docs/theory\.md, sections? ([\d.]+(?:(?:,| to| and) [\d.]+)*)", comments):
        yield from re.findall(r"\d+(?:\.\d+)?", numbers)


def check_sections(theory):
    sections = set(re.findall(r"^##+ (\d+(?:\.\d+)?)", theory, re.M))
    cited = [(path, number) for path in CODE for number in cited_sections(path.read_text())]
    assert len(cited) > 30, cited
    wrong = [(str(path.relative_to(ROOT)), number) for path, number in cited if number not in sections]
    assert not wrong, f"docs/theory.md has no such section: {wrong}"


def check_files(documents):
    names = {path.name for path in (*CODE, *(ROOT / "examples").rglob("*.py"))}
    mentioned = {name for text in documents for name in re.findall(r"`(\w+\.(?:cpp|hpp|py))`", text)} - {"my_law.cpp"}
    assert len(mentioned) > 30, mentioned
    assert mentioned <= names, f"documents in docs/ mention files that are not there: {mentioned - names}"


def check_paths(documents):
    """Paths of the repository in documents lead to a file or folder."""
    tops = "common|stage1_plate|stage2_extract|stage3_nonlinear|tests|scripts|schemas|docs|examples"
    mentioned = {path for text in documents for path in re.findall(rf"`((?:{tops})/[\w/.-]*\w)", text)}
    assert len(mentioned) > 60, mentioned
    missing = {path for path in mentioned if not (ROOT / path).exists()}
    assert not missing, f"documents mention paths that are not there: {missing}"


def check_glossary(glossary):
    words = {word for path in CODE if "tests" not in path.parts for word in re.findall(r"\w+", path.read_text())}
    rows = [line for line in glossary.splitlines() if line.startswith("| ") and not line.startswith("| term")]
    names = {name for row in rows for name in re.findall(r"`(?:\w+::)*(\w+)`", row.split("|")[-2])}
    assert len(names) > 60, names
    assert names <= words, f"docs/glossary.md names what code does not have: {names - words}"


def check_links(document):
    text = document.read_text()
    anchors = {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
               for heading in re.findall(r"^#+ (.*)$", text, re.M)}
    for target in re.findall(r"\]\(([^)]+)\)", text):
        path, _, anchor = target.partition("#")
        assert not path or (document.parent / path).exists(), f"{document.name}: no file {path}"
        assert path or anchor in anchors, f"{document.name}: no heading {anchor}"


def check_warnings(results):
    """The table of docs/results.md has the codes that files with warnings hold, each once, and in order."""
    sources = [text for path in CODE if path.parts[len(ROOT.parts)].startswith("stage") and path.suffix == ".cpp"
               for text in [path.read_text()] if re.search(r"program::(Warning|warn)\b|WarningList", text)]
    codes = {code for text in sources for code in re.findall(r'"([a-z]+(?:-[a-z]+)+)"', text)}
    rows = re.findall(r"^\| `([a-z-]+)` \| [^|]+ \| [^|]+ \|$", results.split("\n## Warnings\n")[1].split("\n## ")[0], re.M)
    assert len(rows) > 25 and rows == sorted(codes), set(rows) ^ codes


def main():
    documents = [ROOT / "docs" / name for name in ("theory.md", "glossary.md")]
    theory, glossary = (document.read_text() for document in documents)
    check_sections(theory)
    pages = [path.read_text() for path in (ROOT / "README.md", *ROOT.glob("docs/*.md"), *ROOT.glob("examples/*/README.md"))]
    check_files(pages)
    check_paths(pages)
    check_glossary(glossary)
    check_warnings((ROOT / "docs/results.md").read_text())
    for document in documents:
        check_links(document)


if __name__ == "__main__":
    main()
