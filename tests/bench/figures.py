"""The output of every benchmark in Python, and the rule that a benchmark whose subject did not run fails and
prints no figure; figures.h gives the reasons. Uses Python's standard library alone."""
import json
import math
import os
import subprocess
import sys


class DidNotRun(Exception):
    """Ends the benchmark with this message."""


def did_not_run(subject, found, way_out):
    """Ends the benchmark with the subject that does not run or does not exist, what was found instead, and the
    way out."""
    raise DidNotRun(f"{subject}: {found}; {way_out}")


class Measured(float):
    """A finite number made from `count` measurements, at least one; `what` names them."""

    def __new__(cls, value, count, what):
        if not count > 0:
            raise DidNotRun(f"no {what} were measured")
        if not math.isfinite(value):
            raise DidNotRun(f"{what}: {value} of {count} measurements is no figure")
        made = super().__new__(cls, value)
        made.count = count
        return made


def share_of(part, whole, what):
    return Measured(part / whole if whole else math.nan, whole, what)


def mean_of(values, what):
    values = [float(value) for value in values]
    return Measured(sum(values) / len(values) if values else math.nan, len(values), what)


class Report:
    """The results so far, which are held back until everything has been measured."""

    def __init__(self, bench):
        self.bench, self.lines, self.figures, self.more = bench, [], {}, {}

    def text(self, line):
        """Adds a line to the table for people."""
        self.lines.append(line)

    def figure(self, name, measured, unit):
        """Adds a figure for programs; `unit` is a unit's symbol, "1" for a pure number."""
        assert name not in self.figures, name
        self.figures[name] = {"value": float(measured), "unit": unit, "count": measured.count}

    def object(self):
        """Prints one object for programs; `more` are further members of this benchmark's own."""
        return {"bench": self.bench, "machine": {"cores": os.cpu_count()},
                "figures": self.figures, **self.more}

    def print(self, as_json):
        if not self.figures:
            raise DidNotRun("it measured nothing")
        print(json.dumps(self.object()) if as_json else "\n".join(self.lines), flush=True)


def note(what):
    """Prints at once, on standard error, what the benchmark is doing; figures do not belong here."""
    print(what, file=sys.stderr, flush=True)


def run(command, subject, way_out):
    """The standard output of a command; ends the benchmark if the command fails."""
    command = [str(word) for word in command]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        did_not_run(subject, f"{command[0]}: {error.strerror}", way_out)
    if done.returncode != 0:
        said = done.stderr.strip()[-300:] or "it said nothing"
        did_not_run(subject, f"exit status {done.returncode} of {' '.join(command)}; {said}", way_out)
    return done.stdout


def run_bench(bench, as_json, measure):
    """The rest of a benchmark's main() after it has read its options; ends the process. `measure` returns
    whether the figures are within their limits."""
    # No figure must be printed after an unexpected exception either.
    try:
        report = Report(bench)
        kept = measure(report)
        report.print(as_json)
    except DidNotRun as error:
        sys.exit(f"bench {bench}: no figures: {error}")
    except (OSError, ValueError, LookupError, subprocess.SubprocessError) as error:
        sys.exit(f"bench {bench}: no figures: {type(error).__name__}: {error}")
    sys.exit(0 if kept else 1)
