#!/usr/bin/env python3
"""Prints the newest values from MERLIN's shared memory: read_merlin.py [NAME [FIELD ...]]

Needs nothing but Python 3: the segment describes itself. NAME is merlin-devices or merlin-wall.
"""
import mmap, struct, sys

HEADER = "<IIQQqqII108s108s"   # magic .. field_count, endpoints; then the table of fields
FIELD = "<40s16s4sIII"         # name, unit, type, count, offset, slot

def text(raw):
    return raw.split(b"\0")[0].decode()

def read(memory, type_, count, offset, slot):
    """One field, whole: the sequence of its slot is even, and the same before and after."""
    for _ in range(1000):
        before, = struct.unpack_from("<Q", memory, slot) if slot else (2,)  # 0: a word by itself
        values = struct.unpack_from(f"<{count}{type_}", memory, offset)
        if before % 2 == 0 and (not slot or before == struct.unpack_from("<Q", memory, slot)[0]):
            return (text(values[0]) if type_ == "s" else values) if before else None
    return None

name, wanted = (sys.argv[1:2] or ["merlin-devices"])[0], sys.argv[2:]
with open(f"/dev/shm/{name}", "rb") as file:
    memory = mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ)
magic, version, *_, count, _, _ = struct.unpack_from(HEADER, memory)
assert magic == 0x4E4C524D and version == 1, "not a segment of MERLIN's that this script knows"
for i in range(count):
    raw = struct.unpack_from(FIELD, memory, struct.calcsize(HEADER) + i * struct.calcsize(FIELD))
    field, unit, type_ = map(text, raw[:3])
    if not wanted or field in wanted:
        print(field, read(memory, type_, *raw[3:]), unit)
