# SPDX-License-Identifier: GPL-3.0-or-later
"""More edits of HDF5 files with h5py, to the same rules as in hdf5_edits.py: links, layouts, filters, attributes, and what
the file has that nobody asked for."""
import h5py
import numpy as np

from hdf5_edits import dtype_of, put


def link(random, file, path):
    """A link in place of a dataset: soft, hard, external; to another one, to itself, to nothing, around."""
    others = [name for name in names(file) if name != path]
    other = random.choice(others)
    target = random.choice([lambda: h5py.SoftLink("/" + other), lambda: h5py.SoftLink("/" + path),
                            lambda: h5py.SoftLink("/nothing"), lambda: h5py.SoftLink("/" + "a/" * 5000), lambda: file[other],
                            lambda: h5py.ExternalLink("elsewhere.h5", "/" + path), lambda: h5py.ExternalLink("missing.h5", "/x"),
                            lambda: h5py.ExternalLink("/dev/zero", "/x"), lambda: h5py.ExternalLink("fifo", "/x"),
                            lambda: h5py.ExternalLink(file.filename.rsplit("/", 1)[-1], "/" + path), lambda: file["/"]])()
    del file[path]
    file[path] = target
    return False


def group_link(random, file, path):
    """A link in place of a group with all that is in it. Nothing there can be edited any more: h5py would follow the
    link, and wait for a pipe."""
    around = path.split("/")[:-1]
    if not around:
        return link(random, file, path)
    group_path = "/".join(around[:random.randint(1, len(around))])
    files = ["fifo", "elsewhere.h5", "a-folder", "missing.h5", "/dev/zero", file.filename.rsplit("/", 1)[-1]]
    outside = h5py.ExternalLink(random.choice(files), random.choice(["/x", "/" + group_path]))
    within = h5py.SoftLink(random.choice(["/nothing", "/" + group_path, "/"]))
    target = random.choice([outside, outside, outside, within, within, file["/"]])
    del file[group_path]
    file[group_path] = target
    return False


def moved(random, file, path):
    """The dataset under another name, with a soft or hard link, or a copy, in its place: all is there."""
    file.move(path, "moved_away")
    kind = random.randrange(3)
    if kind == 0:
        file[path] = h5py.SoftLink("/moved_away")
    elif kind == 1:
        file[path] = file["moved_away"]
    else:
        file.copy("moved_away", path)
    return True


def group(random, file, path):
    """A group in place of a dataset, or a dataset in place of a group."""
    if random.random() < 0.5 and "/" in path:
        path = path.split("/")[0]
        del file[path]
        file[path] = np.zeros(3)
    else:
        del file[path]
        file.create_group(path)
    return False


def virtual(random, file, path):
    """Values that are said to stand in another dataset, in another file, or in the dataset itself."""
    shape, dtype = file[path].shape, dtype_of(file, path)
    if shape == () or 0 in shape:
        return True
    layout = h5py.VirtualLayout(shape, dtype)
    name = random.choice([".", "elsewhere.h5", "missing.h5", "/dev/zero", "fifo"])
    layout[...] = h5py.VirtualSource(name, path, shape, dtype)
    del file[path]
    file.create_virtual_dataset(path, layout)
    return False


def external(random, file, path):
    shape, dtype = file[path].shape, file[path].dtype
    if dtype.kind == "O" or shape == ():
        return True
    size = int(np.prod(shape)) * dtype.itemsize
    name = random.choice(["binary", "missing", "/dev/zero", "/dev/null", "fifo", "."])
    put(file, path, shape=shape, dtype=dtype, external=[(name, 0, random.choice([size, h5py.h5f.UNLIMITED]))])
    return False


def filtered(random, file, path):
    """Compressed, shuffled, checked and chunked data hold the same numbers."""
    values = file[path][()]
    if np.ndim(values) == 0 or np.size(values) == 0:
        return True
    rank = np.ndim(values)
    options = random.choice([{"compression": "gzip"}, {"compression": "gzip", "shuffle": True}, {"shuffle": True},
                             {"fletcher32": True}, {"chunks": (1,) * rank}, {"chunks": np.shape(values)},
                             {"maxshape": (None,) * rank}])
    put(file, path, data=values, dtype=dtype_of(file, path), **options)
    return True


def unknown_filter(random, file, path):
    """A filter that only h5py has, one that nobody has, or chunks that are not what their filter makes."""
    values = np.array(file[path][()])
    if values.ndim == 0 or values.size == 0 or values.dtype.kind == "O":
        return True
    if random.random() < 0.3:
        put(file, path, data=values, compression="lzf")
        return False
    del file[path]
    plist = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    plist.set_chunk(values.shape)
    if random.random() < 0.5:
        plist.set_filter(random.choice([256, 305, 32000, 32015, 65535]), h5py.h5z.FLAG_OPTIONAL, (1, 2, 3))
    else:
        plist.set_deflate(6)
    lcpl = h5py.h5p.create(h5py.h5p.LINK_CREATE)
    lcpl.set_create_intermediate_group(True)
    space = h5py.h5s.create_simple(values.shape)
    set_ = h5py.h5d.create(file.id, path.encode(), h5py.h5t.py_create(values.dtype, logical=True), space, plist, lcpl)
    data = random.choice([values.tobytes(), b"\x78\x9c" + bytes(100), random.randbytes(values.nbytes), b"\x00"])
    set_.write_direct_chunk((0,) * values.ndim, data, filter_mask=0)
    return False


def layout(random, file, path):
    """Compact data, or data whose space is allotted late, hold the same numbers; what was never written reads as zeros."""
    values = np.array(file[path][()])
    if values.dtype.kind == "O" or values.nbytes > 60000:
        return True
    written = random.random() < 0.7
    attributes = dict(file[path].attrs)
    del file[path]
    plist = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    plist.set_layout(h5py.h5d.COMPACT if random.random() < 0.6 else h5py.h5d.CONTIGUOUS)
    lcpl = h5py.h5p.create(h5py.h5p.LINK_CREATE)
    lcpl.set_create_intermediate_group(True)
    space = h5py.h5s.create_simple(values.shape) if values.shape else h5py.h5s.create(h5py.h5s.SCALAR)
    h5py.h5d.create(file.id, path.encode(), h5py.h5t.py_create(values.dtype, logical=True), space, plist, lcpl)
    if written and values.size:
        file[path][...] = values
    for name, value in attributes.items():
        file[path].attrs[name] = value
    return bool(written or not values.size)


def wild(random):
    """Values of attributes."""
    return random.choice([
        lambda: 0, lambda: -1, lambda: 1.5, lambda: "", lambda: "x" * 60000, lambda: np.zeros(0), lambda: np.arange(3),
        lambda: [1, 10**9], lambda: [10**9, 1], lambda: [-1, -1], lambda: [2**63 - 1, 0], lambda: "mm",
        lambda: ["a", "b"], lambda: h5py.Empty("f8"),
        lambda: h5py.Empty(h5py.string_dtype()), lambda: np.bytes_(b"\xff\xfe"), lambda: True, lambda: np.float32("nan"),
        lambda: np.zeros((), [("a", "i4")]), lambda: "{\"length\": \"mm\"", lambda: "{\"length\": 1, \"force\": []}",
        lambda: "[" * 50000,
        lambda: np.zeros((2, 2), "i4"), lambda: "\x1b[31m\n%s"])()


def attribute(random, file, path):
    """An attribute of the root or of the dataset: another value, or none, or one that large."""
    owner = file if random.random() < 0.7 else file[path]
    known = list(owner.attrs)
    if not known:
        return True
    name = random.choice(known)
    if random.random() < 0.2:
        del owner.attrs[name]
    elif random.random() < 0.15 and "version" in file.attrs:
        file.attrs["version"] = np.array([file.attrs["version"][0], random.choice([0, 99, 10**9, -1])], "i4")
    else:
        owner.attrs[name] = wild(random)
    return False


def strangers(random, file, path):
    """Datasets, groups and attributes that nobody reads."""
    kind = random.randrange(5)
    if kind == 0:
        for i in range(3000):
            file[f"stranger{i}"] = i
    elif kind == 1:
        file["/".join(["deep"] * 500)] = 1
    elif kind == 2:
        for i in range(2000):
            file[path].attrs[f"a{i}"] = i
    elif kind == 3:
        file["around/again"] = file["/"]
        file["nowhere"] = h5py.SoftLink("/nowhere")
    else:
        file.create_dataset("stranger", shape=(2**60,), chunks=(2**16,), dtype="f8")
        file["type"] = np.dtype([("a", "f8")])
    return True


def names(file):
    """Paths of all datasets that an edit can read without claims of their size filling the memory, in a fixed order."""
    found = []

    def visit(name, item):
        if isinstance(item, h5py.Dataset) and (item.size or 0) < 10**5:
            found.append(name)

    file.visititems(visit)
    return sorted(found)


def rewritten(random, source, target):
    """The whole file anew with another version of the format, a block of the user's in front, or pages."""
    options = random.choice([{"libver": "latest"}, {"libver": ("v108", "v108")}, {"userblock_size": 512},
                             {"userblock_size": 4096}, {"track_order": True},
                             {"libver": "latest", "fs_strategy": "page", "fs_page_size": 4096}])
    with h5py.File(source) as old, h5py.File(target, "w", **options) as new:
        for name in old:
            old.copy(name, new)
        for name, value in old.attrs.items():
            new.attrs[name] = value
    return True


LAYOUT = [link] * 3 + [group_link] * 2 + [moved, group, group] + [virtual] * 2 + [external] + \
         [filtered] * 2 + [unknown_filter] * 2 + [layout] * 2 + [attribute] * 5 + [strangers]
