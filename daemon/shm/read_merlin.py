#!/usr/bin/env python3
"""Prints the newest values from MERLIN's shared memory: read_merlin.py [SEGMENT [FIELD ...]]

Needs only Python 3, because the segment describes itself. SEGMENT is merlin-devices, merlin-wall
or merlin-framebuffer.
"""
import mmap, struct, sys

HEADER = "<IIQQIIII"             # magic, version, size, generation, table: offset, count, size; pid
FIELD = "<48s24s8sIIIIIIII"      # name, unit, type, count, step, offset, slot, ring (3 numbers)
VERSIONS = {0x4E4C524D: 6, 0x42464D4D: 4}  # of each kind of segment, by its magic

def text(raw):
    return raw.split(b"\0")[0].decode(errors="replace")

def values(memory, type_, count, step, offset):
    """The values of a field. `type_`: struct format of one value; `step`: bytes between values."""
    found = [struct.unpack_from("<" + type_, memory, offset + i * step)[0] for i in range(count)]
    return [text(v) if isinstance(v, bytes) else v for v in found]

def read(memory, type_, count, step, offset, slot):
    """A consistent copy of a field's newest values: the sequence number of its slot is even, and the
    same before and after. None if it was never written. A field without a slot has no sequence."""
    for _ in range(1000):
        before, = struct.unpack_from("<Q", memory, slot) if slot else (2,)
        found = values(memory, type_, count, step, offset)
        if before % 2 == 0 and (not slot or before == struct.unpack_from("<Q", memory, slot)[0]):
            return found if before else None
    return None

def open_segment(name):
    """The memory of a segment, and its table of fields: {name: (unit, what read() needs)}."""
    with open(f"/dev/shm/{name}", "rb") as file:
        memory = mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ)
    magic, version, _, _, table, fields, size, _ = struct.unpack_from(HEADER, memory)
    if VERSIONS.get(magic) != version:
        sys.exit(f"read_merlin.py: {name} is not a segment of MERLIN that this program knows")
    entries = [struct.unpack_from(FIELD, memory, table + i * size) for i in range(fields)]
    return memory, {text(e[0]): (text(e[1]), (text(e[2]), *e[3:7])) for e in entries}

if __name__ == "__main__":
    name, wanted = (sys.argv[1:2] or ["merlin-devices"])[0], sys.argv[2:]
    memory, table = open_segment(name)
    for field, (unit, place) in table.items():
        if not wanted or field in wanted:
            print(field, read(memory, *place), unit)
