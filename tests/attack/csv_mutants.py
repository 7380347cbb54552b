# SPDX-License-Identifier: GPL-3.0-or-later
"""Damage to CSV files of numbers, which have a heading of names: as spreadsheets, editors and copies do it.

A mutant takes a random generator and the lines of a file, and returns its bytes with what must come of it: SAME, the
numbers as before or a refusal, REFUSED, or ANY of both.
"""
from json_mutants import of_bytes

SAME, REFUSED, ANY = "same", "refused", "any"
NO_NUMBERS = ["", "-", "x", "nan", "NaN", "inf", "-Infinity", "1e400", "0x10", "1_000", "--1", "1 2", "1/2", "1.2.3",
              "\uff11", "=1+1", "1e", "0.01 mm", "\x00", "1\x00"]


def rows_of(lines):
    """The lines below the heading as lists of cells."""
    return [[cell.strip() for cell in line.split(",")] for line in lines[1:]]


def text_of(heading, rows, separator=", "):
    return "\n".join([heading, *(separator.join(row) for row in rows), ""]).encode(errors="surrogatepass")


def blank_lines(random, lines):
    lines = list(lines)
    for _ in range(random.choice([1, 3, 100000])):
        lines.insert(random.randrange(1, len(lines) + 1), random.choice(["", "", " ", "\t", "\r"]))
    return "\n".join(lines).encode(), SAME


def line_ends(random, lines):
    end = random.choice(["\r\n", "\r\n\r\n", "\r", " \n", "\t\n", "\n\n"])
    return (end.join(lines) + random.choice(["", end])).encode(), SAME if "\n" in end else ANY


def quotes(random, lines):
    """All cells, or one, in quotes; or a quote that is not closed."""
    which = random.randrange(3)
    if which == 0:
        return "\n".join(", ".join(f'"{cell.strip()}"' for cell in line.split(",")) for line in lines).encode(), SAME
    rows = rows_of(lines)
    row = random.choice(rows)
    i = random.randrange(len(row))
    row[i] = f'"{row[i]}"' if which == 1 else random.choice([f'"{row[i]}', f'{row[i]}"', f'"{row[i]}""'])
    return text_of(lines[0], rows), SAME


def byte_order_mark(random, lines):
    text = "\n".join(lines)
    if random.random() < 0.5:
        return ("\ufeff" + text).encode(), SAME
    return text.encode(random.choice(["utf-16", "utf-32", "utf-16-le", "utf-16-be"])), REFUSED


def decimal_commas(random, lines):
    """As in many languages of Europe: in all rows or one, beside commas, in quotes, or with other separators."""
    rows = rows_of(lines)
    chosen = rows if random.random() < 0.5 else [random.choice([row for row in rows if "." in "".join(row)])]
    quote = random.choice(["", '"'])
    for row in chosen:
        row[:] = [f"{quote}{cell.replace('.', ',')}{quote}" if "." in cell else cell for cell in row]
    separator = random.choice([", ", ",", ";", "; ", "\t", " "])
    return text_of(separator.join(cell.strip() for cell in lines[0].split(",")), rows, separator), REFUSED


def surplus(random, lines):
    """More cells than the heading has names: at the end, where they change nothing, or so that the others move."""
    rows = rows_of(lines)
    chosen = rows if random.random() < 0.3 else [random.choice(rows)]
    cell, at_end = random.choice(["", "0.5", "7", "x"]), random.random() < 0.5
    for row in chosen:
        row.insert(len(row) if at_end else random.randrange(len(row)), cell)
    return text_of(lines[0], rows), SAME if at_end else REFUSED


def lacking(random, lines):
    rows = rows_of(lines)
    row = random.choice(rows)
    row[:] = row[:-1]
    return text_of(lines[0], rows), SAME


def no_number(random, lines):
    """The first cell of a row, which every file here uses, is none."""
    rows = rows_of(lines)
    random.choice(rows)[0] = random.choice(NO_NUMBERS)
    return text_of(lines[0], rows), REFUSED


def null_byte(random, lines):
    data = "\n".join(lines).encode()
    at = random.randrange(len(data) + 1)
    return data[:at] + b"\x00" * random.choice([1, 1, 1000]) + data[at:], SAME


def headings(random, lines):
    """A heading of other names, of one name twice, of none; or no row below it."""
    names = [name.strip() for name in lines[0].split(",")]
    turned, twice = ", ".join(names[::-1]), ", ".join(names[:1] * 2)
    heading = random.choice([turned, twice, "", ",", "a" * 10**6, "x, y, z", lines[1]])
    without_rows = random.choice([lines[0].encode(), b"", b"\n" * 1000]), REFUSED
    return random.choice([("\n".join([heading, *lines[1:]]).encode(), ANY), without_rows])


def large(random, lines):
    """A long cell, many cells, many rows."""
    rows = rows_of(lines)
    many = random.choice([[["1" * 10**6, "1"]], [["0." + "0" * 10**6 + "1", "1"]], [["1"] * 10**5],
                          [[str(10 + i), "9000"] for i in range(10**5)]])
    return text_of(lines[0], rows + many), ANY


def any_bytes(random, lines):
    return of_bytes(random, "\n".join(lines)), ANY


MUTANTS = [blank_lines, line_ends, quotes, byte_order_mark, decimal_commas, decimal_commas, surplus, surplus, lacking,
           no_number, no_number, null_byte, headings, large, any_bytes, any_bytes]


def mutant(random, text):
    return random.choice(MUTANTS)(random, text.rstrip("\n").split("\n"))
