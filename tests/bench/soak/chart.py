"""The chart of a soak: resident memory of each process and late frames of each minute, over time."""

COLOURS = {"wall": "#d7191c", "devices": "#2c7bb6", "page": "#1a9641"}
WIDTH, HEIGHT, LEFT, TOP, GAP = 800, 220, 70, 30, 60  # of a panel [px]


def panel(title, lines, colour_of, most_x, y0):
    """`lines`: {name: [(minutes, value)]}; the y axis begins at 0."""
    most_y = 1.05 * max((y for line in lines.values() for _, y in line), default=1) or 1

    def px(x, y):
        return LEFT + WIDTH * x / most_x, y0 + HEIGHT * (1 - y / most_y)

    svg = [f'<rect x="{LEFT}" y="{y0}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#404040"/>',
           f'<text x="{LEFT}" y="{y0 - 8}" font-weight="bold">{title}</text>']
    for share in (0, 0.25, 0.5, 0.75, 1):
        x, y = px(share * most_x, share * most_y)
        svg.append(f'<text x="{x:.0f}" y="{y0 + HEIGHT + 15}" text-anchor="middle">'
                   f'{share * most_x:.3g} min</text><text x="{LEFT - 6}" y="{y + 4:.0f}" '
                   f'text-anchor="end">{share * most_y:.3g}</text>')
    for i, (name, line) in enumerate(lines.items()):
        points = " ".join("{:.1f},{:.1f}".format(*px(*p)) for p in line)
        svg.append(f'<polyline points="{points}" fill="none" stroke="{colour_of(name)}" stroke-width="1.5"/>'
                   f'<text x="{LEFT + WIDTH + 8}" y="{y0 + 15 + 18 * i}" fill="{colour_of(name)}">{name}'
                   '</text>')
    return svg


def write(path, samples, frames):
    """`samples`: {role: [Sample]}; the line of a restarted process goes on from the time of its restart."""
    memory = {role: [(s.at_s / 60, s.memory_mib) for s in all_] for role, all_ in samples.items()}
    late = {"wall": [(i + at, 100 * late / max(deadlines, 1))
                     for i, (deadlines, late) in enumerate(frames.minutes) for at in (0, 1)]}
    most_x = max([len(frames.minutes)] + [x for line in memory.values() for x, _ in line] + [1])
    svg = panel("resident memory [MiB]", memory, COLOURS.get, most_x, TOP)
    svg += panel("late frames of each minute [%]", late, COLOURS.get, most_x, TOP + HEIGHT + GAP)
    width, height = LEFT + WIDTH + 90, TOP + 2 * (HEIGHT + GAP)
    with open(path, "w", encoding="utf8") as file:
        file.write(f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
                   f'viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="11">'
                   '<rect width="100%" height="100%" fill="white"/>' + "\n".join(svg) + "</svg>\n")
