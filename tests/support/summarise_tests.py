#!/usr/bin/env python3
"""Prints what a successful CTest run does not show: the skipped tests with their reasons, and the slowest tests.

usage: summarise_tests.py RESULTS.xml     (as ctest --output-junit writes it)
"""
import re
import sys
import xml.etree.ElementTree as ElementTree

SLOWEST = 10


def skip_reason(case):
    """The text of GTEST_SKIP(), or else CTest's own message."""
    output = case.findtext("system-out") or ""
    found = re.search(r": Skipped\n(.*?)\n(?:\[|$)", output, re.S)
    if found and found.group(1).strip():
        return " ".join(found.group(1).split())
    element = case.find("skipped")
    return (element.get("message") if element is not None else "") or "no reason given"


def main():
    cases = list(ElementTree.parse(sys.argv[1]).getroot().iter("testcase"))
    if not cases:
        sys.exit("summarise_tests: no test ran")
    skipped = [c for c in cases if c.find("skipped") is not None]
    print(f"{len(cases)} tests, {len(skipped)} skipped")
    for case in skipped:
        print(f"  skipped: {case.get('name')}: {skip_reason(case)}")
    total = sum(float(c.get("time") or 0) for c in cases)
    print(f"the {SLOWEST} slowest of {total:.0f} s of tests:")
    for case in sorted(cases, key=lambda c: -float(c.get("time") or 0))[:SLOWEST]:
        print(f"  {float(case.get('time') or 0):7.1f} s  {case.get('name')}")


if __name__ == "__main__":
    main()
