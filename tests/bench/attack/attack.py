#!/usr/bin/env python3
"""./dev bench attack: what an attack does to the wall, beside the same attacker on a bare sink.

A table of cases, each of which prints its figures, and fails where they are beyond its limit or
where the attack did not reach merlind. Python's own library alone. A group of cases is a module
with a list CASES, named in GROUPS below.
"""
import argparse
import os
import sys
import tempfile

import devices
import sockets

GROUPS = [devices, sockets]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bin", required=True, help="the folder of merlin and merlind")
    parser.add_argument("--source", required=True, help="the source tree")
    parser.add_argument("--seconds", type=float, default=15, help="of one turn")
    parser.add_argument("--rounds", type=int, default=3, help="turns of each side")
    parser.add_argument("--soak-seconds", type=float, default=600, help="of the case soak")
    parser.add_argument("case", nargs="*", help="names; without: all but soak")
    options = parser.parse_args()
    cases = [case for group in GROUPS for case in group.CASES]
    unknown = set(options.case) - {case.name for case in cases}
    if unknown:
        sys.exit(f"attack: no case is named {', '.join(sorted(unknown))}; there are "
                 f"{', '.join(case.name for case in cases)}")
    failed = []
    with tempfile.TemporaryDirectory(prefix="merlin-attack-") as folder:
        options.folder, options.model = folder, os.path.join(folder, "model.mrm")
        for case in cases:
            by_name_only = getattr(case, "by_name_only", False)
            if case.name not in options.case and (options.case or by_name_only):
                continue
            try:
                case.run(options)
            except AssertionError as wrong:
                failed.append(case.name)
                print(f"{case.name}: FAILED: {wrong}", flush=True)
    sys.exit(f"attack: {len(failed)} failed: {', '.join(failed)}" if failed else 0)


if __name__ == "__main__":
    main()
