#!/usr/bin/env python3
"""Prints one level of an .mrm file as OBJ: mrm_reader.py FILE [LEVEL]; level 0 is the whole mesh.

Written from render/lod/io/FORMAT.md alone, with the standard library of Python 3 alone. It has no XXH3, so
this program checks magic, version and sizes, but no checksums.
"""
import struct, sys

HEADER = "<8sIIQQQQ6fQQ"  # magic, version, sections, file size, N, C, triangles, box, checksums
ENTRY = "<IIQQQ32s"       # kind, values a row, offset, rows, checksum, name
SECTIONS = {1: ("positions", "f"), 3: ("parents", "I"), 4: ("triangles", "I"), 5: ("alive", "I")}

def fail(what):
    sys.exit(f"{sys.argv[1]}: {what}")

def sections(data, count):
    """The sections that a cut needs, by name, each as a flat tuple."""
    found = {}
    for i in range(count):
        at = struct.calcsize(HEADER) + i * struct.calcsize(ENTRY)
        kind, dimension, offset, rows, _, _ = struct.unpack_from(ENTRY, data, at)
        if kind not in SECTIONS:
            continue
        name, letter = SECTIONS[kind]
        if offset + 4 * dimension * rows > len(data):
            fail(f"section {name} does not lie in the file")
        found[name] = struct.unpack_from(f"<{dimension * rows}{letter}", data, offset)
    return found

def cut(data, level):
    """Positions of the nodes alive at `level`, and its triangles, as flat lists."""
    if len(data) < struct.calcsize(HEADER) or data[:8] != b"MRLN.mrm":
        fail("is no .mrm file")
    _, version, count, size, nodes, collapses, triangles, *_ = struct.unpack_from(HEADER, data)
    if version != 1:
        fail(f"is version {version}, this script reads 1")
    if size != len(data) or struct.calcsize(HEADER) + count * struct.calcsize(ENTRY) > size:
        fail(f"has {len(data)} bytes, its header says {size}")
    s = sections(data, count)
    sizes = {"positions": 3 * nodes, "parents": collapses, "triangles": 3 * triangles,
             "alive": collapses + 1}
    if any(len(s.get(name, ())) != n for name, n in sizes.items()):
        fail("a section is missing, or its size is not what the header says")
    if not 0 <= level <= collapses:
        fail(f"has levels 0 to {collapses}")
    corners = list(s["triangles"][:3 * s["alive"][level]])
    alive = nodes - 2 * level
    for i, node in enumerate(corners):
        while node >= alive:
            node = s["parents"][(nodes - 1 - node) // 2]
        corners[i] = node
    return s["positions"][:3 * alive], corners

with open(sys.argv[1], "rb") as file:
    points, corners = cut(file.read(), int(sys.argv[2]) if len(sys.argv) > 2 else 0)
for i in range(0, len(points), 3):
    print("v", *points[i:i + 3])
for i in range(0, len(corners), 3):
    print("f", *(node + 1 for node in corners[i:i + 3]))
