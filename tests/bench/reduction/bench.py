#!/usr/bin/env python3
"""./dev bench reduction: MERLIN's costs and every peer that was built, on equal meshes.

Each program reduces in a process of its own, in turns in every round; the least of its seconds counts. README.md
beside this file says what is counted and what a figure means.
"""
import argparse
import hashlib
import json
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

import chart
import data
import figures
import report

REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
WAY_OUT = "'./dev bench reduction' builds it"

# name, executable, arguments before the file, what the mesh has to have, Debian package
PEERS = [
    ("meshoptimizer", "bench_meshoptimizer", "plain", "", "libmeshoptimizer-dev"),
    ("meshoptimizer, colour", "bench_meshoptimizer", "colour", "colour", "libmeshoptimizer-dev"),
    ("CGAL Lindstrom-Turk", "bench_cgal", "lt", "", "libcgal-dev"),
    ("CGAL Garland-Heckbert", "bench_cgal", "gh", "", "libcgal-dev"),
    ("OpenMesh quadric", "bench_openmesh", "quadric", "", "libopenmesh-dev"),
    ("VTK quadric", "bench_vtk", "plain", "", "libvtk9-dev"),
    ("VTK quadric, colour", "bench_vtk", "colour=0.01", "colour", "libvtk9-dev"),
    ("VTK quadric, less colour", "bench_vtk", "colour=0.003", "colour", "libvtk9-dev"),
]

# name, cost, threads, weights, what the mesh has to have
COSTS = [
    ("quadric, 1 thread", "quadric", "1", "default", ""),
    ("quadric, 2 threads", "quadric", "2", "default", ""),
    ("quadric, without colour", "quadric", "2", "colour=0", "colour"),
    ("fast, 1 thread", "fast", "1", "default", ""),
    ("fast, 2 threads", "fast", "2", "default", ""),
    ("fast, without colour", "fast", "2", "colour=0", "colour"),
    ("pattern, 1 thread", "pattern", "1", "default", ""),
    ("pattern, 2 threads", "pattern", "2", "default", ""),
]

OURS = {cost[0] for cost in COSTS}

# name, how it is made. Scans of several kinds, used if they exist beside the repository.
SCANS = [
    ("nefertiti", lambda d, ply: d / "models/odedstein/nefertiti/nefertiti-lowres.obj"),
    ("hammer", lambda d, ply: d / "models/odedstein/hammer/hammer.obj"),
    ("ankylosaurus", lambda d, ply: REPOSITORY / "config/models/ankylosaurus.ply"),
    ("kinect", lambda d, ply: data.range_image(d / "range/pcl/milk_cartoon.depth_mm.pgm",
                                               d / "range/pcl/milk_cartoon.colour.ppm", ply)),
    ("n44w072", lambda d, ply: data.heights(d / "dem/N44W072.hgt", ply, 2)),
]


def digest(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()[:24]


def line_of(command):
    """The JSON line that a program prints; if it fails, its message on standard error."""
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode != 0:
        why = (done.stderr.strip().splitlines() or [f"exit status {done.returncode}"])[-1]
        return {"skipped": why}
    return json.loads(done.stdout.strip().splitlines()[-1])


class Bench:
    def __init__(self, options):
        self.options = options
        self.programs = options.bin / "bench"
        self.merlin = options.bin / "bin/merlin"
        self.work = options.out / "work"
        self.memo = options.out / "memo"
        for folder in (self.work, self.memo):
            folder.mkdir(parents=True, exist_ok=True)
        for subject in (self.programs / "bench_merlin", self.merlin):
            if not subject.exists():
                figures.did_not_run(subject, "there is no such program", WAY_OUT)
        self.missing = set()
        self.seen = {}  # errors of this run, by the digest of the file

    # Meshes

    def prepare(self, name, source):
        """Makes the mesh that all programs get; None if it cannot be read."""
        ply = self.work / f"{name}.ply"
        kind = line_of([self.programs / "bench_merlin", "prepare", source, ply])
        if "skipped" in kind:
            figures.note(f"skipped: {name}: {kind['skipped']}")
            return None
        kind.update(name=name, path=ply, sha=digest(ply))
        return kind

    def meshes(self):
        wanted = SCANS if self.options.data.is_dir() else []
        if self.options.quick or not wanted:
            wanted = [scan for scan in SCANS if scan[0] == "ankylosaurus"]
        if self.options.scans is not None:
            wanted = [scan for scan in wanted if scan[0] in self.options.scans.split(",")]
        for name, source_of in wanted:
            made = self.work / f"{name}.source.ply"
            yield self.prepare(name, source_of(self.options.data, made) or made)
        for path in self.options.meshes:
            mesh = self.prepare(pathlib.Path(path).stem, path)
            if mesh is None:
                figures.did_not_run(path, "it cannot be read as a mesh", "name a .ply or .obj")
            yield mesh

    # Runs

    def remembered(self, key, run):
        """Runs `run` and keeps its figures; with --reuse returns those of an earlier run."""
        path = self.memo / (hashlib.sha256(key.encode()).hexdigest()[:24] + ".json")
        if self.options.reuse and path.exists():
            return json.loads(path.read_text())
        answer = run()
        path.write_text(json.dumps(answer))
        return answer

    def run_peer(self, peer, mesh, level):
        name, program, variant, _, _ = peer
        out = self.work / f"{mesh['sha']}.{program}.{variant}.{level:g}.ply"
        command = [self.programs / program, variant, mesh["path"], target(mesh, level), out]

        def run():
            line = line_of(command)
            if "skipped" not in line:
                line["file"] = str(out)
            return line
        if name == "meshoptimizer":  # the reference for seconds, so it always runs
            return {level: run()}
        key = f"{mesh['sha']} {program} {variant} {level} {digest(command[0])}"
        return {level: self.remembered(key, run)}

    def run_cost(self, cost, mesh):
        name, kind, threads, weights, _ = cost
        out = self.work / f"{mesh['sha']}.{name.replace(', ', '.').replace(' ', '')}"
        targets = {level: target(mesh, level) for level in self.options.levels}
        line = line_of([self.programs / "bench_merlin", kind, threads, weights, mesh["path"], out,
                        *targets.values()])
        if "skipped" in line:
            return {level: line for level in targets}
        line["hierarchy_seconds"] = line["seconds"] + sum(
            line[f"{step}_seconds"] for step in ("normals", "dendrogram", "write"))
        levels = line.pop("levels")
        return {level: dict(line, triangles=levels[str(n)], file=f"{out}.{n}.ply")
                for level, n in targets.items()}

    def jobs(self, mesh):
        """(name, function that runs the program at one level or at all) of each program, in turns."""
        for cost in COSTS:
            if not cost[4] or mesh[cost[4]]:
                yield cost[0], lambda cost=cost: self.run_cost(cost, mesh)
        for peer in PEERS:
            if peer[3] and not mesh[peer[3]]:
                continue
            if not (self.programs / peer[1]).exists():
                self.missing.add(f"{peer[1]} (install {peer[4]})")
                continue
            for level in self.options.levels:
                yield peer[0], lambda p=peer, lv=level: self.run_peer(p, mesh, lv)

    def rounds(self, mesh):
        """rows[name, level]: the line of the first run, with the least seconds of all rounds."""
        rows, done = {}, set()
        for number in range(self.options.rounds):
            for job, (name, run) in enumerate(self.jobs(mesh)):
                if job in done:
                    continue
                for level, line in run().items():
                    keep_least(rows.setdefault((name, level), line), line)
                    if line.get("seconds", self.options.slow + 1) > self.options.slow:
                        done.add(job)  # slow, so that one run has to do; or skipped
            figures.note(f"{mesh['name']}: round {number + 1} of {self.options.rounds}")
        return rows

    # Errors

    def errors(self, mesh, line):
        def run():
            return line_of([self.merlin, "mesh", "compare", mesh["path"], line["file"], "--json",
                            "--width", self.options.width])
        sha = digest(line["file"])
        key = f"{mesh['sha']} {sha} {self.options.width}"
        if key not in self.seen:
            self.seen[key] = self.remembered(key, run)
        answer = self.seen[key]
        if "skipped" in answer:
            return {"skipped": answer["skipped"]}
        return {"rms": answer["rms_percent"], "max": answer["max_low_percent"],
                "max_high": answer["max_high_percent"], "colour": answer["colour_rms_255"],
                "sha": sha}

    def measure(self, mesh):
        figures.note(f"{mesh['name']}: " + report.kind(mesh))
        rows = []
        for (name, level), line in self.rounds(mesh).items():
            row = {"mesh": mesh["name"], "level": level, "target": target(mesh, level),
                   "program": name, **line}
            if "file" in line:
                row.update(self.errors(mesh, line))
            if "skipped" not in row:
                row["rate"] = row["collapses"] / row["seconds"]
                row["cpu_rate"] = row["collapses"] / row["cpu_seconds"]
                row["bytes_per_edge"] = row["memory_bytes"] / mesh["edges"]
            rows.append(row)
        ours = [row for row in rows if row["program"] in OURS]
        if all("skipped" in row for row in ours):
            figures.did_not_run(f"MERLIN on {mesh['name']}", ours[0]["skipped"], WAY_OUT)
        return rows


def keep_least(row, line):
    """Puts the smaller seconds of both into the row."""
    for key in row.keys() & line.keys():
        if key.endswith("seconds"):
            row[key] = min(row[key], line[key])


def target(mesh, level):
    return int(mesh["triangles"] * level / 100)


def options_of():
    parser = argparse.ArgumentParser(prog="./dev bench reduction", description=__doc__)
    parser.add_argument("meshes", nargs="*", metavar="MESH", help="further meshes, PLY or OBJ")
    parser.add_argument("--quick", action="store_true",
                        help="the repository's own model, and MESH, in two rounds")
    parser.add_argument("--scans", metavar="NAME,...", help="scans to use, of " + ", ".join(
        name for name, _ in SCANS) + "; the default is all that exist, empty: none")
    parser.add_argument("--levels", default="10,5,1", help="triangles to be kept, in percent")
    parser.add_argument("--rounds", type=int, help="number of rounds; 3, with --quick 2")
    parser.add_argument("--slow", type=float,
                        help="a program that takes more seconds runs in the first round only; 5, with --quick 0.5")
    parser.add_argument("--width", default="0.005",
                        help="width of the certified maximum's interval, in percent of the diagonal")
    parser.add_argument("--reuse", action="store_true",
                        help="take the peers (except meshoptimizer) and errors from earlier runs")
    parser.add_argument("--json", action="store_true", help="all figures as one JSON object")
    parser.add_argument("--bin", type=pathlib.Path, default=REPOSITORY / "build/release")
    parser.add_argument("--data", type=pathlib.Path, default=REPOSITORY.parent / "shared/data")
    parser.add_argument("--out", type=pathlib.Path, default=REPOSITORY / "build/bench/reduction")
    options = parser.parse_args()
    options.levels = [float(level) for level in options.levels.split(",")]
    options.rounds = options.rounds or (2 if options.quick else 3)
    options.slow = options.slow or (0.5 if options.quick else 5)
    return options


def all_of(meshes, rows):
    return {"meshes": meshes, "rows": rows, "summary": report.summary(rows)}


def write(out, meshes, rows, missing):
    (out / "table.txt").write_text(report.text(meshes, rows, missing))
    (out / "figures.json").write_text(json.dumps(all_of(meshes, rows), indent=1))
    chart.write(out / "chart.svg", meshes, rows)


def tell(result, meshes, rows, missing):
    """Reports MERLIN's rates and the ratios to each available peer as figures, everything else as further members."""
    result.text(report.text(meshes, rows, missing).rstrip("\n"))
    for row in rows:
        if row["program"] in OURS and "skipped" not in row:
            result.figure(f"{row['mesh']}.{row['level']:g}.{row['program']}.rate", figures.Measured(
                row["rate"], row["collapses"], "collapses"), "1/s")
    for ratio in report.summary(rows):
        name = f"{ratio['program']}.{ratio['figure']}.by.{ratio['peer']}"
        result.figure(name, figures.Measured(ratio["mean"], ratio["cells"], "cells"), "1")
    result.more = all_of(meshes, rows)


def measure(options, result):
    bench = Bench(options)
    meshes, rows, missing = [], [], []
    for mesh in filter(None, bench.meshes()):
        meshes.append({k: v for k, v in mesh.items() if k != "path"})
        rows += bench.measure(mesh)
        missing = sorted(bench.missing)
        write(options.out, meshes, rows, missing)  # after each mesh, since partial results are useful
    if not meshes:
        figures.did_not_run("MERLIN", "there is no mesh to reduce", "see --scans and --data")
    tell(result, meshes, rows, missing)
    figures.note(f"in {options.out}: table.txt, chart.svg, figures.json")
    return True


def main():
    options = options_of()
    figures.run_bench("reduction", options.json, lambda result: measure(options, result))


if __name__ == "__main__":
    main()
