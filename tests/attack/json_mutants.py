# SPDX-License-Identifier: GPL-3.0-or-later
"""Damage to JSON texts: of their structure, of their numbers and names, and of their bytes."""
import copy

from json_tree import Members, Token, dump, parse, places

# Numbers that readers, sums and products stumble over.
NUMBERS = ["0", "-0", "-0.0", "-1", "1", "2", "0.5", "1e-320", "5e-324", "2.2250738585072014e-308", "1e-300", "1e-30", "1e-16",
           "1e16", "1e30", "1.0000001e30", "1e150", "1e154", "1e300", "-1e300", "1.7976931348623157e308", "1e308", "1e309",
           "1e400", "-1e400", "1e99999", "1e-99999", "NaN", "nan", "Infinity", "-Infinity", "2147483647", "2147483648",
           "-2147483648", "-2147483649", "4294967296", "9223372036854775807", "9223372036854775808", "18446744073709551616",
           "1" * 400, "0." + "0" * 400 + "1", "1e", "1.", ".5", "+1", "01", "0x10", "1e+", "--1", "1_000", "1,5", "١"]
# Keys whose large numbers or long lists are valid and take long: they get small numbers, and numbers that are refused.
COSTLY = {"increments", "samples", "n", "max_iterations", "harmonics", "waves", "rings", "p", "seed"}
CHEAP_NUMBERS = ["0", "-1", "1", "2", "3", "2.5", "7", "1e18", "-1e300", "4294967297", "1e400", "NaN", "1.0", "2.0000001"]
LONG_LISTS_ARE_VALID = {"values", "increments", "weights"}
STRINGS = ["", " ", "\"", "\\", "'", "/", "a/b", "a:b", ":", "::", "..", ".", "*", "~", "~1", "%s%n%p", "{}", "{0}", "\n", "\t",
           "\x7f", "\x1b[31m", "\u0085", "\u2028", "\ufeff", "\U0001f600", "\u0301" * 50, "a" * 256, "b" * 5000, "c" * 10**6,
           "nan", "ground", "x", "y", "+x", "1", "external:P", "$(touch fallen)", "; touch fallen", "-o", "--help", "NUL"]


def values(random):
    """A value of some other type."""
    return random.choice([
        lambda: None, lambda: True, lambda: False, lambda: [], lambda: Members(), lambda: "text", lambda: Token("7"),
        lambda: [[]], lambda: [None], lambda: Members([["", None]]), lambda: Token("-1.5"), lambda: [Token("1"), Token("2")],
        lambda: Members([["x", Token("1")]])])()


def some(random, tree, wanted=lambda place: True):
    """One place of those that are wanted; None if there is none."""
    found = [place for place in places(tree) if wanted(place)]
    return random.choice(found) if found else None


def is_number(place):
    return isinstance(place.value, Token)


def drop(random, tree):
    place = some(random, tree)
    del place.parent[place.index]


def repeat(random, tree):
    """A key or an item twice, or many times."""
    place = some(random, tree)
    times = 1 if place.key in COSTLY | LONG_LISTS_ARE_VALID else random.choice([1, 1, 2, 100])
    place.parent[place.index:place.index] = [copy.deepcopy(place.parent[place.index]) for _ in range(times)]


def retype(random, tree):
    some(random, tree).put(values(random))


def swap(random, tree):
    a, b = (some(random, tree, lambda place: place.key not in COSTLY) for _ in range(2))
    first, second = copy.deepcopy(a.value), copy.deepcopy(b.value)
    a.put(second)
    b.put(first)


def shuffle(random, tree):
    place = some(random, tree, lambda place: isinstance(place.value, list))
    random.shuffle(place.value)


def number(random, tree):
    place = some(random, tree, is_number)
    place.put(Token(random.choice(CHEAP_NUMBERS if place.key in COSTLY else NUMBERS)))


def scale(random, tree):
    """Numbers that may well be valid: one times a power of ten, or turned around."""
    place = some(random, tree, lambda place: is_number(place) and place.key not in COSTLY)
    factor = random.choice([-1, 0.999999, 1.000001, 0.5, 2, 10.0 ** random.randint(-40, 40), 10.0 ** random.randint(-8, 8)])
    place.put(Token(repr(float(place.value.text) * factor)))


def scale_all(random, tree):
    """All numbers of one key, times the same."""
    key, factor = some(random, tree, is_number).key, 10.0 ** random.randint(-20, 20)
    for place in list(places(tree)):
        if is_number(place) and place.key == key and key not in COSTLY | {"version", "quads", "edge"}:
            place.put(Token(repr(float(place.value.text) * factor)))


def nest(random, tree):
    depth = random.choice([50, 99, 100, 101, 1000, 100000])
    open_, close = random.choice([("[", "]"), ('{"a":', "}"), ('[{"b":', "}]")])
    some(random, tree).put(Token(open_ * depth + random.choice(["", "1"] if open_ == "[" else ["1"]) +
                                 (close * depth if random.random() < 0.8 else "")))


def lengthen(random, tree):
    """A list of 1e5 entries: the same one, rising numbers, or small objects."""
    place = some(random, tree, lambda place: isinstance(place.value, list) and not isinstance(place.value, Members) and
                 place.value and place.key not in COSTLY | LONG_LISTS_ARE_VALID)
    if place:
        item = dump(random.choice(place.value))
        item = item if len(item) < 100 else "0"  # 1e5 long texts do not fit into memory
        place.put(Token("[" + ", ".join(random.choice([[item] * 100000, map(str, range(100000)), ["{}"] * 100000])) + "]"))


def rename(random, tree):
    """A name, everywhere it stands, becomes a strange one: what refers to it goes along."""
    place = some(random, tree, lambda place: isinstance(place.value, str) or isinstance(place.parent, Members))
    old = place.value if isinstance(place.value, str) and random.random() < 0.5 else place.key
    new = random.choice(STRINGS)
    for place in list(places(tree)):
        if place.value == old:
            place.put(new)
        elif isinstance(place.value, str) and place.value.endswith(f":{old}"):
            place.put(f"{place.value[:-len(old)]}{new}")
        if isinstance(place.parent, Members) and place.parent[place.index][0] == old:
            place.parent[place.index][0] = new


def string(random, tree):
    """One text becomes a strange one, or another of the same file: names twice, references to other things."""
    place = some(random, tree, lambda place: isinstance(place.value, str))
    others = [other.value for other in places(tree) if isinstance(other.value, str)]
    place.put(random.choice(random.choice([STRINGS, others, ["missing", "missing:1", "strap:missing"]])))


def extra_key(random, tree):
    place = some(random, tree, lambda place: isinstance(place.value, Members))
    (place.value if place else tree).append([random.choice(STRINGS), values(random)])


def path(random, tree):
    """A path to something that is no such file: files and folders that DamagedJson puts there."""
    place = some(random, tree, lambda place: isinstance(place.value, str) and place.value.endswith((".h5", ".csv")))
    if place:
        place.put(random.choice([
            "..", ".", "/", "/dev/null", "/dev/zero", "/dev/full", "/dev/stdin", "/dev/fd/0", "/proc/self/mem",
            "/proc/self/environ", "fifo", "loop", "dangling", "a-folder", "empty", "mutant.json", "output.h5", "rivet.csv",
            "plate_strap.h5",
            f"../{'x/../' * 1000}y", "z" * 256, "z/" * 3000, "./" * 2000 + place.value, f"a-folder/../{place.value}",
            place.value + "/", place.value + "\n", "file://" + place.value, "~/" + place.value, "//" + place.value, "binary"]))


TREE = [drop, drop, repeat, retype, retype, swap, swap, shuffle, number, number, number, scale, scale, scale, scale_all, nest,
        lengthen, rename, rename, string, string, extra_key, path, path]


def structural(random, text):
    """One to three of these at a time; the damage of the first may leave the second nothing to work at."""
    tree = parse(text)
    for _ in range(random.choice([1, 1, 1, 2, 3])):
        try:
            random.choice(TREE)(random, tree)
        except (AttributeError, IndexError, TypeError, ValueError):
            pass
    return dump(tree).encode(errors="surrogatepass")


INSERTS = [b"\x00", b"\xff", b"\xc0\x80", b"\xed\xa0\x80", b"\xf5\x80\x80\x80", b"\xe2\x82", b"\xef\xbb\xbf", b"/*", b"//", b"*/",
           b"\"", b"{", b"}", b"[", b"]", b",", b":", b"\\u0000", b"\\ud800", b"\\", b"\r", b"-", b"e", b"\x1a", b" " * 10**6,
           b"\n" * 10**5, b"/*" * 10**5, b"[" * 10**5, b"1" * 10**6, b"#", b"'"]


def of_bytes(random, text):
    """Truncated, flipped, cut, doubled, filled or recoded text."""
    data = bytearray(text.encode())
    for _ in range(random.choice([1, 1, 2, 5])):
        a, n = random.randrange(len(data) + 1), random.choice([1, 2, 10, 100])
        kind = random.randrange(8)
        if kind == 0:
            del data[a:]
        elif kind == 1 and data:
            for _ in range(n):
                data[random.randrange(len(data))] ^= 1 << random.randrange(8)
        elif kind == 2:
            del data[a:a + n]
        elif kind == 3:
            data[a:a] = data[a:a + n]
        elif kind == 4:
            data[a:a] = random.choice(INSERTS)
        elif kind == 5:
            data[a:a + n] = bytes(random.randrange(256) for _ in range(min(n, 10)))
        elif kind == 6:
            data[:0] = random.choice([b"\xef\xbb\xbf", b"\xff\xfe", b"\xfe\xff", b"\x00", b" " * 1000, b"//\n", b"/* */"])
        else:
            data += random.choice([b"{}", b"]", b"\x00", b"//", b"/*", b" " * 10**6, bytes(data[:1000])])
    return bytes(data)


def recoded(random, text):
    return random.choice([text.encode("utf-16"), text.encode("utf-32"), text.encode("utf-16-le"), text.encode()[::-1],
                          b"", b" ", b"null", b"[]", b"{}", b"1", b'""', text.encode() * 2, b"[" * 10**6, b"{\"a\":" * 10**5,
                          b"[" * 10**5 + b"]" * 10**5, b"\"" + b"a" * 10**7 + b"\"", b"/*" + b"*" * 10**7])


def mutant(random, text):
    return random.choice([structural] * 14 + [of_bytes] * 5 + [recoded])(random, text)
