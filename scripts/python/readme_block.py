# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables in Markdown, and the block of a file that a script prints: between <!-- NAME --> and <!-- /NAME -->."""
import sys
from pathlib import Path


def markdown_table(header, rows):
    return "".join("| " + " | ".join(row) + " |\n" for row in [header, ["---"] * len(header), *rows])


def replace_block(path, name, text):
    first, last = f"<!-- {name} -->\n", f"<!-- /{name} -->"
    before, found, rest = Path(path).read_text().partition(first)
    _, ended, after = rest.partition(last)
    if not (found and ended):
        sys.exit(f"{name}: error: {path} has no block from {first.strip()} to {last}")
    Path(path).write_text(before + first + text + last + after)
