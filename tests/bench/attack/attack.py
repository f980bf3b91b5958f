#!/usr/bin/env python3
"""./dev bench attack: the effect of attacks on the wall, compared with the same attacker on a bare sink.

Runs a table of cases. Each case reports its figures, and fails if they are beyond its limit. If an attack did
not reach merlind, the benchmark has no figures. Uses Python's standard library alone. A group of cases is a
module with a list CASES, named in GROUPS below.
"""
import argparse
import os
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir))

import control
import devices
import figures
import sockets

GROUPS = [devices, sockets, control]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bin", required=True, help="the folder of merlin and merlind")
    parser.add_argument("--source", required=True, help="the source tree")
    parser.add_argument("--seconds", type=float, default=15, help="length of one turn")
    parser.add_argument("--rounds", type=int, default=3, help="number of turns of each side")
    parser.add_argument("--soak-seconds", type=float, default=600, help="length of the case soak")
    parser.add_argument("--json", action="store_true", help="the figures as one JSON object")
    parser.add_argument("case", nargs="*", help="names of cases; the default is all but soak")
    options = parser.parse_args()
    cases = [case for group in GROUPS for case in group.CASES]
    unknown = set(options.case) - {case.name for case in cases}
    if unknown:
        sys.exit(f"attack: no case is named {', '.join(sorted(unknown))}; there are "
                 f"{', '.join(case.name for case in cases)}")
    if not options.seconds > 0 or options.rounds < 1:
        parser.error("--seconds is more than 0, and --rounds at least 1")

    def measure(report):
        failed = []
        with tempfile.TemporaryDirectory(prefix="merlin-attack-") as folder:
            options.folder, options.model = folder, os.path.join(folder, "model.mrm")
            for case in cases:
                by_name_only = getattr(case, "by_name_only", False)
                if case.name not in options.case and (options.case or by_name_only):
                    continue
                try:
                    case.run(options, report)
                except AssertionError as wrong:
                    failed.append(case.name)
                    report.text(f"{case.name}: FAILED: {wrong}")
                    figures.note(f"{case.name}: FAILED: {wrong}")  # also if it is the only case
        if failed:
            figures.note(f"attack: {len(failed)} failed: {', '.join(failed)}")
        return not failed

    figures.run_bench("attack", options.json, measure)


if __name__ == "__main__":
    main()
