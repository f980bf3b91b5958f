#!/usr/bin/env python3
"""./dev bench size: how the cost of merlin mesh reduce grows from 10^4 to 10^8 triangles.

Copies of one scan are laid out as tiles (tile_scan): the surface is real, its repetition synthetic. Each size
runs the whole command with --memory. Compared are the collapses in a second of processor time, since other
programs on the machine cost wall time; both are printed. Uses Python's standard library alone.
"""
import argparse
import json
import os
import resource
import tempfile

import figures

SIZES = (10_000, 100_000, 1_000_000, 3_000_000, 10_000_000, 30_000_000, 100_000_000)
WAY_OUT = "'./dev bench size' builds merlin and tile_scan"


def run(command):
    """The command's output, and the processor seconds of the command alone."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    output = figures.run(command, os.path.basename(command[0]), WAY_OUT)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return output, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measure(options, triangles, folder):
    mesh, model = os.path.join(folder, "tiles.ply"), os.path.join(folder, "tiles.mrm")
    run([options.tile_scan, options.scan, str(triangles), mesh])
    command = [options.merlin, "mesh", "reduce", mesh, "-o", model, "--json"]
    if options.memory:
        command += ["--memory", options.memory]
    best = None
    # Single short runs are noisy, so the best of several counts; all sizes do about the same work in total.
    for _ in range(max(1, min(5, 2_000_000 // triangles))):
        output, seconds = run(command)
        report = json.loads(output[output.index("{"):])
        report["cpu"] = seconds
        if best is None or seconds < best["cpu"]:
            best = report
    os.remove(mesh)
    os.remove(model)
    return best


def table(options, rows, report):
    report.text(f"{options.scan} in tiles, --memory {options.memory}; whole command, rates in "
                "collapses a second;\n'of 1M': of the rate by processor time at a million "
                "triangles; bytes/edge: the peak, mesh included")
    report.text(f"{'triangles':>11} {'wall s':>8} {'cpu s':>8} {'reducing/s':>11} {'all/s':>9} "
                f"{'all/cpu s':>9} {'of 1M':>6} {'peak MiB':>9} {'bytes/edge':>10} {'blocks':>6}")
    rates = {n: figures.Measured(r["collapses"] / r["cpu"], r["collapses"],
                                 f"collapses of {n} triangles") for n, r in rows}
    for n, r in rows:
        ratio = f"{rates[n] / rates[1_000_000]:.2f}" if 1_000_000 in rates else "-"
        memory = figures.Measured(r["peak_memory_mb"] * (1 << 20) / (1.5 * n), r["collapses"],
                                  "collapses")
        report.text(f"{n:>11} {r['seconds_all']:>8.2f} {r['cpu']:>8.2f} "
                    f"{r['collapses_per_second']:>11.0f} {r['collapses'] / r['seconds_all']:>9.0f} "
                    f"{rates[n]:>9.0f} {ratio:>6} {r['peak_memory_mb']:>9.0f} {memory:>10.1f} "
                    f"{r['blocks']:>6}")
        report.figure(f"{n}.rate_by_cpu", rates[n], "1/s")
        report.figure(f"{n}.memory_by_edge", memory, "B")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--merlin", required=True)
    parser.add_argument("--tile-scan", required=True)
    parser.add_argument("--scan", required=True)
    parser.add_argument("--memory", default="16G", help="memory that the command may use; 0: the free memory")
    parser.add_argument("--most", type=float, default=1e7,
                        help="the largest mesh; 1e8 takes 7 GB of disk and 11 GB of memory")
    parser.add_argument("--folder", help="folder for the meshes; the default is a temporary one")
    parser.add_argument("--json", action="store_true", help="the figures as one JSON object")
    options = parser.parse_args()
    if not options.most >= SIZES[0]:
        parser.error(f"--most is at least {SIZES[0]}, the smallest mesh")

    def bench(report):
        rows = []
        with tempfile.TemporaryDirectory(dir=options.folder) as folder:
            for n in (n for n in SIZES if n <= options.most):
                rows.append((n, measure(options, n, folder)))
                figures.note(f"  measured {n}")
        table(options, rows, report)
        return True

    figures.run_bench("size", options.json, bench)


if __name__ == "__main__":
    main()
