"""The chart of the reduction benchmark: RMS and seconds against triangles, one line for each program."""
import math
from xml.sax.saxutils import escape

COLOURS = {"quadric, 1 thread": "#d7191c", "quadric, 2 threads": "#d7191c",
           "quadric, without colour": "#f46d43", "fast, 1 thread": "#e7298a",
           "fast, 2 threads": "#e7298a", "fast, without colour": "#f1b6da",
           "pattern, 1 thread": "#7b3294",
           "pattern, 2 threads": "#7b3294", "meshoptimizer": "#1a9641",
           "meshoptimizer, colour": "#66bd63", "CGAL Lindstrom-Turk": "#2c7bb6",
           "CGAL Garland-Heckbert": "#00a6ca", "OpenMesh quadric": "#8c510a",
           "VTK quadric": "#525252", "VTK quadric, colour": "#969696",
           "VTK quadric, less colour": "#bdbdbd"}
DASHED = {"quadric, 1 thread", "fast, 1 thread", "pattern, 1 thread"}

WIDTH, HEIGHT, LEFT, TOP, GAP = 400, 250, 70, 30, 60  # of a panel [px]
LEGEND = 210


class Axis:
    """A logarithmic axis from pixel `low_px` to pixel `high_px`."""

    def __init__(self, values, low_px, high_px):
        low, high = math.log10(min(values)), math.log10(max(values))
        pad = 0.05 * (high - low) or 0.1
        self.low, self.high, self.low_px, self.high_px = low - pad, high + pad, low_px, high_px

    def px(self, value):
        share = (math.log10(value) - self.low) / (self.high - self.low)
        return self.low_px + share * (self.high_px - self.low_px)

    def ticks(self):
        decades = range(math.floor(self.low), math.ceil(self.high) + 1)
        steps = (1, 2, 5) if self.high - self.low < 3 else (1,)
        values = [step * 10.0 ** d for d in decades for step in steps]
        return [v for v in values if self.low <= math.log10(v) <= self.high]


def panel(title, unit, lines, x0, y0):
    """The SVG elements of a panel. `lines`: {program: [(triangles, value)]}."""
    points = [p for line in lines.values() for p in line]
    x = Axis([p[0] for p in points], x0, x0 + WIDTH)
    y = Axis([p[1] for p in points], y0 + HEIGHT, y0)
    svg = [f'<rect x="{x0}" y="{y0}" width="{WIDTH}" height="{HEIGHT}" class="frame"/>',
           f'<text x="{x0}" y="{y0 - 8}" class="title">{escape(title)}</text>']
    for value in x.ticks():
        svg.append(f'<line x1="{x.px(value):.1f}" x2="{x.px(value):.1f}" y1="{y0}" '
                   f'y2="{y0 + HEIGHT}" class="grid"/><text x="{x.px(value):.1f}" '
                   f'y="{y0 + HEIGHT + 15}" text-anchor="middle">{value:,.0f}</text>')
    for value in y.ticks():
        svg.append(f'<line x1="{x0}" x2="{x0 + WIDTH}" y1="{y.px(value):.1f}" '
                   f'y2="{y.px(value):.1f}" class="grid"/><text x="{x0 - 6}" '
                   f'y="{y.px(value) + 4:.1f}" text-anchor="end">{value:g}</text>')
    svg.append(f'<text x="{x0 + WIDTH}" y="{y0 + HEIGHT + 30}" text-anchor="end">triangles kept'
               f'</text><text x="{x0 + WIDTH}" y="{y0 - 8}" text-anchor="end">{escape(unit)}'
               '</text>')
    for program, line in lines.items():
        svg.append(curve(program, [(x.px(a), y.px(b)) for a, b in sorted(line)]))
    return svg


def curve(program, points):
    path = " ".join(f"{a:.1f},{b:.1f}" for a, b in points)
    dots = "".join(f'<circle cx="{a:.1f}" cy="{b:.1f}" r="2.5"/>' for a, b in points)
    dash = ' stroke-dasharray="5 4"' if program in DASHED else ""
    colour = COLOURS.get(program, "#000000")
    return (f'<g stroke="{colour}" fill="{colour}"><polyline points="{path}" fill="none" '
            f'stroke-width="2"{dash}/>{dots}</g>')


def legend(programs, x, y):
    svg = []
    for i, program in enumerate(programs):
        at = y + 20 * i
        svg.append(curve(program, [(x, at), (x + 30, at)]))
        svg.append(f'<text x="{x + 38}" y="{at + 4}">{escape(program)}</text>')
    return svg


def write(path, meshes, rows):
    """A row of two panels for each mesh, with the legend beside them."""
    good = [r for r in rows if "skipped" not in r]
    svg, programs = [], list(dict.fromkeys(r["program"] for r in good))
    for number, mesh in enumerate(meshes):
        y0 = TOP + number * (HEIGHT + GAP)
        for column, (key, title, unit) in enumerate((
                ("rms", "RMS", "% of the diagonal"), ("seconds", "seconds", "s, wall, least"))):
            lines = {p: [(r["triangles"], r[key]) for r in good
                         if r["mesh"] == mesh["name"] and r["program"] == p] for p in programs}
            lines = {p: line for p, line in lines.items() if line}
            if lines:
                svg += panel(f"{mesh['name']}: {title}", unit, lines,
                             LEFT + column * (WIDTH + LEFT), y0)
    x = 2 * (LEFT + WIDTH) + 25
    svg += legend(programs, x, TOP + 10)
    width, height = x + LEGEND, max(TOP + len(meshes) * (HEIGHT + GAP), TOP + 20 * len(programs))
    path.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="11">'
        '<style>.frame{fill:none;stroke:#404040} .grid{stroke:#e0e0e0} '
        '.title{font-weight:bold;font-size:13px}</style>'
        '<rect width="100%" height="100%" fill="white"/>' + "\n".join(svg) + "</svg>\n")
