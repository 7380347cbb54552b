# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits of HDF5 files with h5py: their numbers and texts, and datasets of other shapes and types.

An edit takes a random generator, the open file and a dataset's path, and says whether readers must find the same numbers
as before (True), or may refuse the file or come to others (False).
"""
import h5py
import numpy as np

NUMBERS = [np.nan, np.inf, -np.inf, 0.0, -0.0, -1.0, 1.0, 5e-324, 1e-300, 1e-30, 1e30, 1e154, 1e300, -1e300, 1.7e308]
INTEGERS = [-1, 0, 1, 2, 3, 7, 100, 10**6, 2**30, 2**31 - 1, -2**31, -2**30]
TEXTS = ["", " ", "x", "y", "+x", "-y", "1", "2", "a" * 100000, "\x1b[2J", "\n", "%s%n", "é\u2028", "../..", "rotation", "\x7f"]


def entries(random, file, path):
    """Some entries, or all, become wild ones of their type."""
    set_ = file[path]
    values = set_[()]
    flat = np.atleast_1d(np.array(values)).reshape(-1)
    if flat.size == 0:
        return True
    some = [random.randrange(flat.size) for _ in range(random.choice([1, 1, 2, 5]))]
    chosen = range(flat.size) if random.random() < 0.1 else some
    wild = {"f": NUMBERS, "i": INTEGERS}.get(set_.dtype.kind, TEXTS)
    one = random.choice(wild)
    for i in chosen:
        flat[i] = one
    set_[...] = flat.reshape(np.shape(values))
    return False


def near(random, file, path):
    """One number changes by a little, its sign, or by powers of ten; an index by one."""
    set_ = file[path]
    values = set_[()]
    if set_.dtype.kind not in "if" or values.size == 0:
        return entries(random, file, path)
    flat = np.atleast_1d(values).reshape(-1)
    i = random.randrange(flat.size)
    with np.errstate(over="ignore"):
        flat[i] = flat[i] + random.choice([-1, 1]) if set_.dtype.kind == "i" else flat[i] * random.choice(
            [-1, 1 + 1e-6, 1 - 1e-3, 2, 1e3, 1e-3, 1e100, 1e-100])
    set_[...] = flat.reshape(np.shape(values))
    return False


def permute(random, file, path):
    """Entries in another order, the same one everywhere, rows turned around."""
    set_ = file[path]
    values = set_[()]
    flat = np.atleast_1d(np.array(values)).reshape(-1)
    if flat.size < 2:
        return True
    kind = random.randrange(4)
    if kind == 0:
        flat = flat[random.sample(range(flat.size), flat.size)]
    elif kind == 1:
        flat[random.randrange(flat.size)] = flat[random.randrange(flat.size)]
    elif kind == 2:
        flat[:] = flat[0]
    else:
        flat = flat[::-1]
    set_[...] = flat.reshape(np.shape(values))
    return False


def put(file, path, **options):
    """A dataset in place of one, with its attributes."""
    attributes = dict(file[path].attrs) if path in file else {}
    del file[path]
    new = file.create_dataset(path, **options)
    for name, value in attributes.items():
        new.attrs[name] = value
    return new


def dtype_of(file, path):
    return file[path].dtype if file[path].dtype.kind != "O" else h5py.string_dtype()


def reshape(random, file, path):
    """Other extents: one more or less, none, turned, flat, one dimension more, a scalar."""
    values = np.array(file[path][()])
    dtype = dtype_of(file, path)
    rows = values.shape[0] if values.ndim else 1
    one = np.atleast_1d(values)
    changed = random.choice([
        lambda: one[:-1], lambda: one[:0], lambda: np.concatenate([one, one[-1:]]), lambda: np.concatenate([one] * 3),
        lambda: one.T, lambda: one.reshape(-1), lambda: one[None], lambda: one[..., None],
        lambda: one.reshape(-1)[0] if one.size else one,
        lambda: one[:, :-1] if one.ndim > 1 else one[: rows // 2],
        lambda: np.concatenate([one] * (10**6 // max(one.size, 1000)))])()
    put(file, path, data=changed, dtype=dtype)
    return False


def retype(random, file, path):
    """Other types of the same values where they have one, else of zeros."""
    values = np.array(file[path][()])
    shape = values.shape
    number = values if values.dtype.kind in "if" else np.zeros(shape)
    point = np.dtype([("x", "f8"), ("y", "i4")])
    kind = random.randrange(18)
    if kind < 8:
        dtype = ["f4", "f2", "i8", "u1", ">f8", ">i4", "c16", "longdouble"][kind]
        with np.errstate(over="ignore"):
            put(file, path, data=number.real.astype(dtype))
    elif kind == 8:
        put(file, path, data=np.zeros(shape, point))
    elif kind == 9:
        put(file, path, data=values.astype("S") if values.dtype.kind != "O" else values.astype("S8"))
    elif kind == 10:
        put(file, path, data=np.full(shape, "7", object), dtype=h5py.string_dtype(random.choice(["utf-8", "ascii"])))
    elif kind == 11:
        put(file, path, data=h5py.Empty(random.choice(["f8", "i4", h5py.string_dtype()])))
    elif kind == 12:
        put(file, path, data=np.zeros(shape, bool))
    elif kind == 13:
        put(file, path, data=np.zeros(shape, np.dtype("V16")))
    elif kind == 14:
        put(file, path, shape=shape or (1,), dtype=random.choice([h5py.ref_dtype, h5py.regionref_dtype]))
    elif kind == 15:
        put(file, path, shape=shape or (1,), dtype=h5py.vlen_dtype(random.choice(["f8", "i4"])))
    elif kind == 16:
        put(file, path, shape=shape or (1,), dtype=np.dtype(("f8", (3,))))
    else:
        put(file, path, data=number.real.astype("i4"), dtype=h5py.enum_dtype({"A": 0, "B": 1}, basetype="i4"))
    return False


def claim(random, file, path):
    """Extents that no file holds, of which nothing was ever written."""
    values = np.array(file[path][()])
    rows = random.choice([2**20, 2**28, 2**30, 2**31, 2**32 + 1, 2**40, 2**60, 2**63 - 1])
    shape = random.choice([(rows, *values.shape[1:]), (*values.shape[:-1], rows), (rows,) * max(values.ndim, 1)])
    maximum = random.choice([None, (None,) * len(shape)])
    options = {} if random.random() < 0.2 else {"chunks": tuple(min(extent, 64) or 1 for extent in shape), "maxshape": maximum}
    put(file, path, shape=shape, dtype=dtype_of(file, path), **options)
    return False


def claim_text(random, file, path):
    """Texts of fixed length, which all together no small file holds, and of which nothing was ever written."""
    dtype = random.choice(["S1", "S8", "S1000", h5py.string_dtype("utf-8", 2)])
    shape = (random.choice([2**20, 2**25, 5 * 10**7, 2**26, 2**28, 2**31]),)
    put(file, path, shape=shape, dtype=dtype, **random.choice([{}, {"chunks": (64,)}, {"maxshape": (None,)}]))
    return False


def remove(random, file, path):
    """A dataset, or the group around it."""
    del file[path.rsplit("/", 1)[0] if "/" in path and random.random() < 0.3 else path]
    return False


CONTENT = [entries] * 6 + [near] * 4 + [permute] * 3 + [reshape] * 4 + [retype] * 4 + [claim] * 2 + [claim_text] + \
          [remove] * 2
