"""Meshes for the reduction benchmark, made from height fields and range images and written as PLY."""
import array
import sys


def _big_endian(raw, type_):
    values = array.array(type_, raw)
    if sys.byteorder == "little":
        values.byteswap()
    return values


def _write_ply(path, vertices, colours, triangles):
    """Writes binary PLY. `vertices` and `triangles` are flat arrays, `colours` flat bytes or None."""
    with open(path, "wb") as out:
        out.write(("ply\nformat binary_little_endian 1.0\n"
                   f"element vertex {len(vertices) // 3}\n"
                   "property float x\nproperty float y\nproperty float z\n").encode())
        if colours is not None:
            out.write(b"property uchar red\nproperty uchar green\nproperty uchar blue\n")
        out.write((f"element face {len(triangles) // 3}\n"
                   "property list uchar int vertex_indices\nend_header\n").encode())
        points = vertices.tobytes()
        if colours is None:
            out.write(points)
        else:
            out.write(b"".join(points[12 * i:12 * i + 12] + colours[3 * i:3 * i + 3]
                               for i in range(len(vertices) // 3)))
        corners = triangles.tobytes()
        out.write(b"".join(b"\x03" + corners[i:i + 12] for i in range(0, len(corners), 12)))


def _grid_triangles(width, height, index, near):
    """Two triangles for each cell of the grid, each where its corners exist and are `near` one another."""
    triangles = array.array("i")
    for y in range(height - 1):
        for at in range(y * width, y * width + width - 1):
            below = at + width
            for a, b, c in ((at, below, at + 1), (at + 1, below, below + 1)):
                if index[a] >= 0 and index[b] >= 0 and index[c] >= 0 and near(a, b, c):
                    triangles.extend((index[a], index[b], index[c]))
    return triangles


def heights(hgt, ply, step):
    """An SRTM tile of 3 arc seconds as a height field in metres; uses every `step`th sample."""
    with open(hgt, "rb") as file:
        samples = _big_endian(file.read(), "h")
    side = int(len(samples) ** 0.5)
    kept = range(0, side, step)
    north_m, east_m = 92.6, 68.5  # a sample's height and width at 44 degrees north
    vertices = array.array("f")
    for row in kept:
        for column in kept:
            vertices.extend((column * east_m, -row * north_m, samples[row * side + column]))
    index = range(len(vertices) // 3)
    _write_ply(ply, vertices, None, _grid_triangles(len(kept), len(kept), index, lambda *_: True))


def range_image(depth_pgm, colour_ppm, ply):
    """A Kinect frame (depth in mm, 0: no depth) as a coloured mesh, which is cut where the depth jumps by more
    than 2 %."""
    def pnm(path, bytes_per_pixel):
        with open(path, "rb") as file:
            raw = file.read()
        width, height = map(int, raw.split(maxsplit=3)[1:3])
        return width, height, raw[-width * height * bytes_per_pixel:]

    width, height, raw = pnm(depth_pgm, 2)
    depth, colours = _big_endian(raw, "H"), pnm(colour_ppm, 3)[2]
    focal_px = 525.0
    vertices, kept, index = array.array("f"), bytearray(), [-1] * len(depth)
    for i, z in enumerate(depth):
        if z == 0:
            continue
        index[i] = len(vertices) // 3
        x, y = i % width - (width - 1) / 2, i // width - (height - 1) / 2
        vertices.extend((x * z / focal_px, -y * z / focal_px, -z))
        kept += colours[3 * i:3 * i + 3]

    def near(a, b, c):
        d = depth[a], depth[b], depth[c]
        return max(d) < 1.02 * min(d)

    _write_ply(ply, vertices, kept, _grid_triangles(width, height, index, near))
