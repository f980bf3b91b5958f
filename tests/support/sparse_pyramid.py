#!/usr/bin/env python3
"""Writes a sparse BigTIFF pyramid of any size in the form that MERLIN reads: all tiles but a few are missing
in the file. For tests: a file of 10^11 pixels takes some kilobytes on the disk.

usage: sparse_pyramid.py WIDTH HEIGHT OUT.tif
"""
import struct
import sys
import zlib

TILE = 256


def entry(tag, kind, count, value):
    return struct.pack("<HHQ", tag, kind, count) + value


def number(tag, kind, value):
    return entry(tag, kind, 1, struct.pack("<Q", value))


def levels(width, height):
    yield width, height
    while width > TILE or height > TILE:
        width, height = max(1, width // 2), max(1, height // 2)
        yield width, height


def chequers(dark, bright):
    rows = b""
    for y in range(TILE):
        for x in range(TILE):
            rows += bytes(bright if (x // 32 + y // 32) % 2 else dark)
    return zlib.compress(rows)


def main():
    width, height, path = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
    tile = chequers((20, 30, 60), (200, 180, 120))
    with open(path, "wb") as out:
        out.write(struct.pack("<2sHHHQ", b"II", 43, 8, 0, 0))
        tile_at = out.tell()
        out.write(tile)
        link = 8
        for w, h in levels(width, height):
            columns, rows = -(-w // TILE), -(-h // TILE)
            count = columns * rows
            offsets, sizes = out.tell(), out.tell() + 8 * count
            # The file has the first and the last tile of each level; the tables are otherwise holes in it.
            for i in {0, count - 1, columns // 2 + columns * (rows // 2)}:
                out.seek(offsets + 8 * i)
                out.write(struct.pack("<Q", tile_at))
                out.seek(sizes + 8 * i)
                out.write(struct.pack("<Q", len(tile)))
            directory = sizes + 8 * count
            out.seek(directory)
            def table(tag, at):
                if count == 1:
                    return number(tag, 16, tile_at if tag == 324 else len(tile))
                return entry(tag, 16, count, struct.pack("<Q", at))
            fields = [
                number(254, 4, 0 if link == 8 else 1),
                number(256, 4, w), number(257, 4, h),
                entry(258, 3, 3, struct.pack("<HHHH", 8, 8, 8, 0)),
                number(259, 3, 8), number(262, 3, 2), number(277, 3, 3), number(284, 3, 1),
                number(322, 3, TILE), number(323, 3, TILE),
                table(324, offsets), table(325, sizes),
            ]
            out.write(struct.pack("<Q", len(fields)) + b"".join(fields) + struct.pack("<Q", 0))
            end = out.tell()
            out.seek(link)
            out.write(struct.pack("<Q", directory))
            link = end - 8
            out.seek(end)


if __name__ == "__main__":
    main()
