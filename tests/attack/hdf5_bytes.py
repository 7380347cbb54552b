# SPDX-License-Identifier: GPL-3.0-or-later
"""Damage to the bytes of HDF5 files, as disks, copies and broken programs do it; what two files hold alike."""
import random as generators
import re

import h5py
import numpy as np

SEAL = re.compile(rb"\nfastjoint xxhash [0-9a-f]{16}\n\Z")
SIGNATURE = b"\x89HDF\r\n\x1a\n"


def unsealed(data):
    """The bytes without the seal, as HDF5 leaves them when it edits the file."""
    return SEAL.sub(b"", data)


def flip(random, data):
    for _ in range(random.choice([1, 1, 1, 2, 8, 64, 1000])):
        data[random.randrange(len(data))] ^= 1 << random.randrange(8)


def block(random, data):
    """Start and length of a block: anywhere, or as disks have them; every third one at the end of the file."""
    n = min(random.choice([1, 8, 64, 512, 4096]), len(data))
    start = random.randrange(len(data))
    start = random.choice([start, start // n * n, len(data) - n])
    return start, min(n, len(data) - start)


def zero(random, data):
    start, n = block(random, data)
    data[start:start + n] = bytes(n)


def fill(random, data):
    start, n = block(random, data)
    data[start:start + n] = random.choice([b"\xff" * n, generators.Random(random.random()).randbytes(n), data[:n]])


def swap(random, data):
    a, n = block(random, data)
    b, m = block(random, data)
    n = min(n, m)
    data[a:a + n], data[b:b + n] = data[b:b + n], data[a:a + n]


def truncate(random, data):
    n = random.choice([1, 2, 17, 41, 42, 43, 84, 168, 169, 512, 4096, random.randrange(len(data)), len(data) - 8])
    del data[max(len(data) - n, 0):]


def append(random, data):
    n = random.choice([1, 8, 42, 168, 512, 4096])
    noise = generators.Random(random.random()).randbytes(n)
    data += random.choice([bytes(n), b"\n" * n, noise, bytes(data[-n:]), bytes(data[:n])])


def cut(random, data):
    start, n = block(random, data)
    del data[start:start + n]


def insert(random, data):
    start, n = block(random, data)
    data[start:start] = bytes(n)


def word(random, data):
    """One word of 4 or 8 bytes, where addresses, sizes and counts stand, becomes a wild one, or one from elsewhere."""
    at, n = random.randrange(0, len(data), 4), random.choice([4, 8])
    other = random.randrange(0, len(data), 4)
    data[at:at + n] = random.choice([bytes(n), b"\xff" * n, bytes(data[other:other + n]), at.to_bytes(n, "little"),
                                     (2**31).to_bytes(n, "little"), len(data).to_bytes(n, "little")])


DAMAGE = [flip, flip, flip, zero, zero, fill, swap, swap, truncate, append, cut, insert, word, word]


def damaged(random, data):
    """One kind of damage, or two of them; never the bytes as they were."""
    result = bytearray(data)
    while bytes(result) == data or not result:
        result = bytearray(data)
        for _ in range(random.choice([1, 1, 1, 2])):
            if len(result) > 8:
                random.choice(DAMAGE)(random, result)
    return bytes(result)


def same_numbers(a, b):
    """Whether two outputs hold the same: all datasets and attributes, but for digests, which an edited input has not."""
    if a.suffix != ".h5":
        return a.read_bytes() == b.read_bytes()
    with h5py.File(a) as first, h5py.File(b) as second:
        return content(first) == content(second)


def content(file):
    """All datasets, by path, as bytes or texts, and the attributes of the root."""
    result = {name: np.asarray(value).tolist() for name, value in file.attrs.items() if "digest" not in name}

    def visit(name, item):
        if isinstance(item, h5py.Dataset) and "digest" not in name:
            value = item[()]
            result["/" + name] = value.tobytes() if item.dtype.kind in "if" else np.asarray(value).tolist()
    file.visititems(visit)
    return result
