"""The reduction benchmark's table and summary as text."""
import math

LEAD = "quadric, 2 threads"
GEOMETRY = ("quadric, 2 threads", "quadric, without colour", "fast, 2 threads",
            "fast, without colour")
COLOUR_PEERS = ("meshoptimizer, colour", "VTK quadric, colour", "VTK quadric, less colour")
SPEED_PEER = "meshoptimizer"


def reached(row):
    """Whether the program reached the requested number of triangles; otherwise it is no match for those that did."""
    return row["triangles"] <= 1.02 * row["target"]


def cells(rows, program):
    return {(r["mesh"], r["level"]): r for r in rows
            if r["program"] == program and "skipped" not in r and reached(r)}


def ratios(rows, program, key, peer, peer_key=None):
    """Ratio of a figure of two programs: the geometric mean over meshes and levels, and the ratio of each cell."""
    ours, theirs = cells(rows, program), cells(rows, peer)
    each = {}
    for cell in ours.keys() & theirs.keys():
        a, b = ours[cell].get(key), theirs[cell].get(peer_key or key)
        if a and b:
            each[cell] = a / b
    if not each:
        return None
    worst = max(each, key=each.get)
    least = min(each, key=each.get)
    mean = math.exp(sum(map(math.log, each.values())) / len(each))
    return {"program": program, "figure": key, "peer": peer, "cells": len(each), "mean": mean,
            "largest": each[worst], "largest_at": worst, "least": each[least], "least_at": least,
            "each": sorted([mesh, level, ratio] for (mesh, level), ratio in each.items())}


def summary(rows):
    """The ratios within one run by which MERLIN is judged; None if a program is missing."""
    wanted = []
    for program in GEOMETRY:
        wanted += [(program, "rms", "CGAL Lindstrom-Turk"),
                   (program, "max", "CGAL Garland-Heckbert")]
    for peer in COLOUR_PEERS:
        wanted += [(LEAD, "colour", peer), (LEAD, "rms", peer), (LEAD, "max", peer)]
    for program in ("quadric, 1 thread", LEAD, "fast, 1 thread", "fast, 2 threads"):
        wanted += [(program, "rate", SPEED_PEER)]
    wanted += [("quadric, 1 thread", "cpu_rate", SPEED_PEER),
               (LEAD, "whole_rate", SPEED_PEER, "rate")]
    for row in rows:
        if "hierarchy_seconds" in row:
            row["whole_rate"] = row["collapses"] / row["hierarchy_seconds"]
    return [r for r in (ratios(rows, *w) for w in wanted) if r]


NAMES = {"rms": "RMS", "max": "certified maximum", "colour": "colour RMS", "rate": "collapses/s",
         "cpu_rate": "collapses per CPU second",
         "whole_rate": "collapses/s, with normals, dendrogram and the .mrm file"}


def at(cell):
    return f"{cell[0]} at {cell[1]:g} %"


def summary_lines(meshes, rows):
    lines = ["Ratios, geometric mean over meshes and levels (cells), and the extremes:"]
    for r in summary(rows):
        speed = r["figure"].endswith("rate")
        edge = "least" if speed else "largest"
        lines.append(f"  {r['mean']:6.3f} ({r['cells']:2})  {edge} {r[edge]:6.3f} "
                     f"({at(r[edge + '_at'])})   "
                     f"{NAMES[r['figure']]}: {r['program']} / {r['peer']}")
        over = [f"{m} {level:g} %: {x:.3f}" for m, level, x in r["each"] if not speed and x > 1.10]
        if over:
            lines.append("         above 1.10: " + ", ".join(over))
    lines.append("Memory beyond the loaded mesh, bytes an edge: " + ", ".join(
        f"{mesh['name']} {bytes_of(rows, mesh, LEAD)}" for mesh in meshes))
    lines.append("Same bytes with 1 and 2 threads: " + ", ".join(
        f"{cost} {same_bytes(rows, cost)}" for cost in ("quadric", "fast", "pattern")))
    return lines


def bytes_of(rows, mesh, program):
    found = [r["bytes_per_edge"] for r in cells(rows, program).values()
             if r["mesh"] == mesh["name"]]
    return f"{found[0]:.1f}" if found else "-"


def same_bytes(rows, cost):
    one, two = (cells(rows, f"{cost}, {n}") for n in ("1 thread", "2 threads"))
    both = one.keys() & two.keys()
    if not both:
        return "not measured"
    other = [at(cell) for cell in sorted(both) if one[cell]["sha"] != two[cell]["sha"]]
    return "NO: " + ", ".join(other) if other else f"yes ({len(both)} files)"


COLUMNS = f"{'':26}{'triangles':>10}{'s':>9}{'CPU s':>9}{'k coll/s':>10}{'B/edge':>8}" \
          f"{'RMS %':>10}{'max %':>9}{'colour':>8}"


def row_line(row):
    if "skipped" in row:
        return f"{row['program']:26}skipped: {row['skipped']}"
    colour = f"{row['colour']:8.2f}" if row.get("colour") is not None else f"{'-':>8}"
    return (f"{row['program']:26}{row['triangles']:10}{row['seconds']:9.3f}"
            f"{row['cpu_seconds']:9.3f}{row['rate'] / 1e3:10.0f}{row['bytes_per_edge']:8.1f}"
            f"{row['rms']:10.5f}{row['max']:9.4f}{colour}"
            + ("" if reached(row) else "  stopped early: not compared"))


def kind(mesh):
    """Properties of the mesh, and how it was prepared."""
    parts = [f"{mesh['triangles']} triangles", f"{mesh['components']} components",
             f"{mesh['border_edges']} border edges"]
    for key in ("non_manifold_edges", "contracted_edges", "split_vertices"):
        parts += [f"{mesh[key]} {key.replace('_', ' ')}"] if mesh[key] else []
    return ", ".join(parts)


def text(meshes, rows, missing):
    lines = [f"skipped: {what}: was not there when this was configured" for what in missing]
    for mesh in meshes:
        lines += ["", f"{mesh['name']}: " + kind(mesh)]
        of_mesh = [r for r in rows if r["mesh"] == mesh["name"]]
        for level in sorted({r["level"] for r in of_mesh}, reverse=True):
            lines.append(f"{level:g} % kept".ljust(26) + COLUMNS[26:])
            lines += [row_line(r) for r in of_mesh if r["level"] == level]
    return "\n".join(lines + [""] + summary_lines(meshes, rows)) + "\n"
