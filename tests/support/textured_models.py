#!/usr/bin/env python3
"""Writes synthetic models with several textures into a folder: room.obj, room.wrl and room.gltf.

All three contain the same scene: a floor whose tiles repeat 12 times, a wall with a picture of bricks,
a board that shows a picture once, and a pillar without a picture. No part of it was measured.
"""
import base64
import json
import math
import pathlib
import struct
import sys
import zlib


def png(width, height, colour_at):
    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    rows = b"".join(b"\0" + b"".join(bytes(colour_at(x, y)) for x in range(width)) for y in range(height))
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def tile(x, y):
    return (230, 230, 220) if (x // 32 + y // 32) % 2 else (60, 70, 90)


def brick(x, y):
    row = y // 16
    return (190, 185, 175) if y % 16 < 2 or (x + 32 * (row % 2)) % 64 < 2 else (170, 70 + 10 * (row % 3), 50)


def board(x, y):
    """A frame, and an arrow that points up, by which a test sees that the picture is upright."""
    if min(x, y, 159 - x, 119 - y) < 6:
        return (250, 200, 0)
    arrow = abs(x - 80) < 8 and y > 40 or abs(x - 80) < (y - 20) < 30
    return (255, 255, 255) if arrow else (20, 40 + y, 160)


def quad(corners, repeats):
    return {"corners": corners, "uv": [(0, 0), (repeats[0], 0), (repeats[0], repeats[1]), (0, repeats[1])]}


def pillar():
    quads = []
    ring = [(2.2 + 0.3 * math.cos(a), 1.5 + 0.3 * math.sin(a)) for a in (math.tau * i / 24 for i in range(25))]
    for (x, z), (x1, z1) in zip(ring, ring[1:]):
        quads.append(quad([(x1, 0, z1), (x, 0, z), (x, 2.4, z), (x1, 2.4, z1)], (1, 1)))
    return quads


PARTS = [
    ("floor", "tile.png", (1, 1, 1), [quad([(0, 0, 4), (4, 0, 4), (4, 0, 0), (0, 0, 0)], (12, 12))]),
    ("wall", "brick.png", (1, 1, 1), [quad([(0, 0, 0), (4, 0, 0), (4, 2.5, 0), (0, 2.5, 0)], (3, 2))]),
    ("board", "board.png", (1, 1, 1), [quad([(0.5, 0.8, 0.05), (1.9, 0.8, 0.05), (1.9, 1.9, 0.05), (0.5, 1.9, 0.05)], (1, 1))]),
    ("pillar", None, (0.2, 0.6, 0.3), pillar()),
]
PICTURES = {"tile.png": png(64, 64, tile), "brick.png": png(128, 96, brick), "board.png": png(160, 120, board)}


def obj():
    materials = "".join(
        f"newmtl {name}\nKd {' '.join(map(str, colour))}\n" + (f"map_Kd {picture}\n" if picture else "")
        for name, picture, colour, _ in PARTS)
    text, n = "mtllib room.mtl\n", 0
    for name, picture, _, quads in PARTS:
        text += f"usemtl {name}\n"
        for q in quads:
            text += "".join("v %g %g %g\n" % c for c in q["corners"])
            text += "".join("vt %g %g\n" % t for t in q["uv"])
            text += "f " + " ".join(f"{n + i}/{n + i}" if picture else f"{n + i}" for i in range(1, 5)) + "\n"
            n += 4
    return materials, text


def vrml():
    text = "#VRML V2.0 utf8\n"
    for _, picture, colour, quads in PARTS:
        points = [c for q in quads for c in q["corners"]]
        coordinates = [t for q in quads for t in q["uv"]]
        texture = f"texture ImageTexture {{ url \"{picture}\" }}" if picture else ""
        text += (f"Shape {{ appearance Appearance {{ material Material {{ diffuseColor {' '.join(map(str, colour))} }} {texture} }}\n"
                 " geometry IndexedFaceSet { coord Coordinate { point [ " + ", ".join("%g %g %g" % p for p in points) + " ] }\n"
                 "  texCoord TextureCoordinate { point [ " + ", ".join("%g %g" % t for t in coordinates) + " ] }\n"
                 "  coordIndex [ " + " ".join(f"{i} {i + 1} {i + 2} {i + 3} -1" for i in range(0, len(points), 4)) + " ] } }\n")
    return text


def gltf():
    """The v coordinate for glTF, in which v increases downwards."""
    data, views, accessors, meshes, nodes, materials, images = b"", [], [], [], [], [], []

    def add(values, kind, component, form):
        nonlocal data
        flat = [x for v in values for x in (v if isinstance(v, tuple) else (v,))]
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": 4 * len(flat)})
        data += struct.pack(f"<{len(flat)}{form}", *flat)
        accessor = {"bufferView": len(views) - 1, "componentType": component, "count": len(values), "type": kind}
        if kind == "VEC3":
            accessor["min"] = [min(v[k] for v in values) for k in range(3)]
            accessor["max"] = [max(v[k] for v in values) for k in range(3)]
        accessors.append(accessor)
        return len(accessors) - 1

    for _, picture, colour, quads in PARTS:
        points = [c for q in quads for c in q["corners"]]
        coordinates = [(u, 1 - v) for q in quads for u, v in q["uv"]]
        corners = [i + k for i in range(0, len(points), 4) for k in (0, 1, 2, 0, 2, 3)]
        attributes = {"POSITION": add(points, "VEC3", 5126, "f"), "TEXCOORD_0": add(coordinates, "VEC2", 5126, "f")}
        pbr = {"baseColorFactor": list(colour) + [1]}
        if picture:
            images.append({"uri": picture})
            pbr["baseColorTexture"] = {"index": len(images) - 1}
        materials.append({"pbrMetallicRoughness": pbr})
        meshes.append({"primitives": [{"attributes": attributes, "indices": add(corners, "SCALAR", 5125, "I"), "material": len(materials) - 1}]})
        nodes.append({"mesh": len(meshes) - 1})
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
        "meshes": meshes, "materials": materials, "images": images, "textures": [{"source": i} for i in range(len(images))],
        "accessors": accessors, "bufferViews": views, "buffers": [{"uri": uri, "byteLength": len(data)}]})


def main():
    folder = pathlib.Path(sys.argv[1])
    for name, content in PICTURES.items():
        (folder / name).write_bytes(content)
    materials, text = obj()
    (folder / "room.mtl").write_text(materials)
    (folder / "room.obj").write_text(text)
    (folder / "room.wrl").write_text(vrml())
    (folder / "room.gltf").write_text(gltf())


if __name__ == "__main__":
    main()
