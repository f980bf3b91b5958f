#!/usr/bin/env python3
"""Checks the pictures of a demo: none is black, each quadrant shows something, and tiles continue each other at the seams.

usage: check_wall_picture.py FRAME.png WALL.png COLUMNS

FRAME.png   the frame buffer, whose quadrants are three tiles of the wall and the operator's view
WALL.png    the wall's tiles side by side, in COLUMNS columns
Prints the measured figures; exits with 1 and a sentence if a picture is not that of a working wall.
"""
import struct
import sys
import zlib

LEAST_COVERED = 0.02  # required share of a quadrant's pixels that differ from its background
MOST_AT_SEAM = 3.0    # limit of the mean difference of neighbours across a seam, relative to that inside a tile


def fail(what):
    sys.exit(f"check_wall_picture: {what}")


def unfiltered(kind, line, above, step):
    """Undoes the filter of one line of a PNG file (section 9 of its specification); returns the line's pixels."""
    line = bytearray(line)
    for i in range(len(line)):
        a = line[i - step] if i >= step else 0
        b = above[i]
        c = above[i - step] if i >= step else 0
        if kind == 1:
            line[i] = (line[i] + a) & 255
        elif kind == 2:
            line[i] = (line[i] + b) & 255
        elif kind == 3:
            line[i] = (line[i] + (a + b) // 2) & 255
        elif kind == 4:
            p = a + b - c
            pa, pb, pc = abs(p - a), abs(p - b), abs(p - c)
            line[i] = (line[i] + (a if pa <= pb and pa <= pc else b if pb <= pc else c)) & 255
    return line


def read_png(path):
    """(width, height, bytes a pixel, rows) of a PNG file with 8 bits a channel."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        fail(f"{path} is not a PNG file")
    at, packed, header = 8, b"", None
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        if kind == b"IDAT":
            packed += body
        at += 12 + length
    width, height, depth, colour, _, _, interlaced = header
    if depth != 8 or colour not in (2, 6) or interlaced:
        fail(f"{path} has {depth} bits and colour type {colour}; 8 bits, RGB or RGBA are checked")
    step = 3 if colour == 2 else 4
    raw, rows, above = zlib.decompress(packed), [], bytearray(width * step)
    for y in range(height):
        begin = y * (width * step + 1)
        above = unfiltered(raw[begin], raw[begin + 1:begin + 1 + width * step], above, step)
        rows.append(above)
    return width, height, step, rows


def check_quadrants(path):
    width, height, step, rows = read_png(path)
    for name, x0, y0 in (("upper left", 0, 0), ("upper right", width // 2, 0),
                         ("lower left", 0, height // 2), ("lower right", width // 2, height // 2)):
        counts = {}
        for y in range(y0, y0 + height // 2, 2):
            for x in range(x0, x0 + width // 2, 2):
                pixel = bytes(rows[y][x * step:x * step + 3])
                counts[pixel] = counts.get(pixel, 0) + 1
        total, most = sum(counts.values()), max(counts.values())
        covered = 1 - most / total
        print(f"{name}: {100 * covered:.1f} % differ from its most frequent colour, {len(counts)} colours")
        if covered < LEAST_COVERED or len(counts) < 16:
            fail(f"{path}: the {name} quadrant shows next to nothing")


def check_seams(path, columns):
    width, height, step, rows = read_png(path)
    if width % columns:
        fail(f"{path} is {width} pixels wide, which {columns} tiles of one width cannot be")

    def difference(x):
        """Mean difference of the columns x - 1 and x where at least one is not background."""
        total = count = 0
        background = rows[0][0:3]
        for row in rows:
            left, right = row[(x - 1) * step:(x - 1) * step + 3], row[x * step:x * step + 3]
            if left == background and right == background:
                continue
            total += sum(abs(a - b) for a, b in zip(left, right)) / 3
            count += 1
        return (total / count, count) if count else (0, 0)

    tile = width // columns
    for seam in range(tile, width, tile):
        across, rows_there = difference(seam)
        inside = [difference(x)[0] for x in range(seam - 20, seam + 21, 4) if x != seam]
        usual = sum(inside) / len(inside)
        print(f"seam at {seam}: {across:.1f} of 255 across, {usual:.1f} beside, in {rows_there} rows")
        if rows_there < 10:
            fail(f"{path}: nothing is shown at the seam at {seam}")
        if across > MOST_AT_SEAM * usual + 2:
            fail(f"{path}: the picture does not continue at the seam at {seam}")


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    check_quadrants(sys.argv[1])
    check_seams(sys.argv[2], int(sys.argv[3]))


if __name__ == "__main__":
    main()
