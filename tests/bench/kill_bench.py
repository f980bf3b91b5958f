#!/usr/bin/env python3
"""./dev bench kill: kills merlind's roles with kill -9, and measures how soon there is a picture and data again.

A supervisor restarts at once; what systemd waits before (RestartSec of the units) is added, and the sum is judged. The
devices are emulated and outlive merlind, as real ones do. Times are those of the kernel's monotonic clock: of the
kill, of the last pixel of the new process's first frame, of the first new sample of the slowest device.
"""
import argparse
import math
import os
import re
import signal
import socket
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import figures
import roles
from figures import Measured

PICTURE_S, DATA_S, READY_S = 2.0, 1.0, 1.0  # bounds: of the picture, of data, of a start
COMMON_WAIT_S = 1.0  # a common RestartSec, which is said and not judged
POLL_S, GIVE_UP_S, SETTLE_S = 0.0005, 30, 0.5
BEAT_S = 0.5  # heartbeats come ten times a second; after this time clients regard a role as gone
TRACKER_HZ, MOST_MISSING = 120, 2  # rate of the emulated Fastrak; tolerance for the ends of the interval
SHARES = (("minimum", 0), ("median", 0.5), ("95 %", 0.95), ("99 %", 0.99), ("maximum", 1))
WAY_OUT = "run merlind by hand, its log says why"


def quantile(values, share):
    """The smallest value that is not below this share of all values."""
    values = sorted(values)
    return values[max(0, math.ceil(share * len(values)) - 1)]


def unit_wait_s(role):
    """RestartSec of the role's unit, seconds."""
    unit = os.path.join(roles.SOURCE, "systemd", f"merlin-{role}.service")
    with open(unit, encoding="utf8") as file:
        found = re.search(r"^RestartSec=(\d+(?:\.\d+)?)(ms|s|)$", file.read(), re.MULTILINE)
    if not found:
        figures.did_not_run(unit, "it has no RestartSec= in s or ms", "see systemd/README.md")
    return float(found[1]) * (0.001 if found[2] == "ms" else 1)


class Other:
    """Watches the process that is not killed: whether it goes on."""

    def __init__(self, segment):
        self.segment = segment
        segment.reopen()
        self.generation, self.late_s = segment.value("segment.generation"), 0.0

    def look(self):
        heartbeat_ns = self.segment.value("segment.heartbeat_ns")
        self.late_s = max(self.late_s, (time.monotonic_ns() - heartbeat_ns) / 1e9)

    def missed(self):
        """What the process missed, in words; empty: nothing."""
        self.segment.reopen()
        if self.segment.value("segment.generation") != self.generation:
            return "it was started anew"
        return f"its heartbeat was {self.late_s:.2f} s old" if self.late_s > BEAT_S else ""


class Records:
    """Whether the tracker's records came without a gap: as many as its rate gives between the first and the last."""

    def __init__(self, segment):
        self.segment, self.begin = segment, self.now(segment)

    @staticmethod
    def now(segment):
        segment.reopen()
        return segment.value("tracker1.counter"), segment.value("tracker1.received_ns") / 1e9

    def came(self):
        """(how many came, how many are missing)."""
        end = self.now(self.segment)
        count = end[0] - self.begin[0]
        return count, round((end[1] - self.begin[1]) * TRACKER_HZ) - count


class Bench:
    def __init__(self, options):
        self.options, self.place = options, roles.Place(options, "kill")
        self.place.make_model()
        self.place.configure({"wall": {"rate": {"rate_hz": options.rate}}})
        self.emulators = [roles.Emulator(self.place, name, "turning", options.seed + i)
                          for i, name in enumerate(roles.DRIVERS)]
        self.notify = os.path.join(self.place.folder, "notify")
        self.told = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.told.bind(self.notify)
        self.told.settimeout(GIVE_UP_S)
        environment = {"NOTIFY_SOCKET": self.notify}
        self.programs = {role: self.place.role(role, environment) for role in ("devices", "wall")}
        self.segments = {name: roles.Segment(self.place, name) for name in ("devices", "wall", "framebuffer")}

    def start(self):
        for emulator in self.emulators:
            emulator.start()
        for role, program in self.programs.items():
            program.start()
            self.wait_for_word("READY=1", role)
        time.sleep(2)  # by now the governor knows the machine

    def wait_for_word(self, word, role):
        """Waits until merlind has sent this word to its supervisor; returns when that was."""
        while True:
            try:
                said = self.told.recv(4096).decode()
            except TimeoutError:
                figures.did_not_run(f"merlind --role {role}", f"it did not say {word}", WAY_OUT)
            if word in said.split("\n"):
                return time.monotonic_ns()

    def new_picture(self, since_ns):
        """The end of the oldest frame that was finished after `since_ns`; 0: there is none."""
        finished = self.segments["framebuffer"].values("buffer.finished_ns") or []
        return min((ns for ns in finished if ns > since_ns), default=0)

    def new_data(self, since_ns):
        """The time at which the first samples of all devices had come."""
        segment = self.segments["devices"]
        all_ = [segment.value(f"{name}.received_ns") for name in ("glove", "tracker1", "ball")]
        return max(all_) if min(all_) > since_ns else 0

    def kill(self, role, shown, came, other):
        """Seconds from the kill until the role delivers again, as its segment `shown` shows."""
        program, segment = self.programs[role], self.segments[shown]
        began = time.monotonic_ns()
        program.process.send_signal(signal.SIGKILL)
        program.process.wait()
        ended = time.monotonic_ns()  # what is there by now may be the killed one's
        program.start()
        while True:
            other.look()
            came_ns = came(ended) if segment.reopen() else 0
            if came_ns:
                return (came_ns - began) / 1e9
            if time.monotonic_ns() - began > GIVE_UP_S * 1e9:
                figures.did_not_run(f"merlind --role {role}", f"it delivered nothing for {GIVE_UP_S} s",
                                    WAY_OUT)
            time.sleep(POLL_S)

    def kills(self, role, shown, came, other_role):
        """The times of all kills, and what the other process missed."""
        times, missed = [], []
        for i in range(self.options.times):
            other = Other(self.segments[other_role])
            times.append(self.kill(role, shown, came, other))
            self.wait_for_word("READY=1", role)
            end = time.monotonic() + SETTLE_S
            while time.monotonic() < end:
                other.look()
                time.sleep(POLL_S)
            if what := other.missed():
                missed.append(what)
                figures.note(f"kill {i + 1} of the {role}: the {other_role}: {what}")
            if (i + 1) % 10 == 0:
                figures.note(f"{role}: {i + 1} of {self.options.times} kills")
        return times, missed

    def deadlines(self):
        """(deadlines while something moved, missed ones) of the wall."""
        self.segments["wall"].reopen()
        return [self.segments["wall"].value(f"wall.{name}") for name in ("deadlines", "late")]

    def starts(self, role):
        """Seconds from exec to READY; the other role is running, and the model was read before."""
        times, program = [], self.programs[role]
        for _ in range(self.options.times):
            code = program.stop()
            if code != 0:
                figures.did_not_run(f"merlind --role {role}", f"it ended with {code}", WAY_OUT)
            began = time.monotonic_ns()
            program.start()
            times.append((self.wait_for_word("READY=1", role) - began) / 1e9)
        return times

    def close(self):
        for program in [*self.programs.values(), *self.emulators]:
            program.stop()
        self.told.close()
        self.place.close()


def row(report, name, times, bound):
    """Adds a row; returns whether all times are within the limit."""
    values = [(label, quantile(times, share)) for label, share in SHARES]
    over = sum(t > bound for t in times)
    report.text(f"{name:32}" + "".join(f"{1000 * value:9.0f}" for _, value in values)
                + f"   bound {1000 * bound:.0f}: " + (f"{over} of {len(times)} beyond" if over else "kept"))
    for label, value in values:
        key = f"{name.replace(' ', '_')}.{label.replace(' %', '')}"
        report.figure(key, Measured(1000 * value, len(times), "times"), "ms")
    return not over


def waits(report, name, times, bound):
    """Adds what systemd waits before it starts the unit again. Whether all are within the bound with it."""
    unit = unit_wait_s(name)
    for wait, whose in ((unit, "the unit's"), (COMMON_WAIT_S, "a common")):
        over = sum(t + wait > bound for t in times)
        report.text(f"  with {whose} RestartSec={1000 * wait:.0f}ms: at most {1000 * (max(times) + wait):.0f} ms; "
                    f"{over} of {len(times)} beyond {1000 * bound:.0f}")
        report.figure(f"{name}.restart_sec_{1000 * wait:.0f}.maximum",
                      Measured(1000 * (max(times) + wait), len(times), "times"), "ms")
    return all(t + unit <= bound for t in times)


def measure(options, report):
    bench = Bench(options)
    try:
        bench.start()
        records = Records(bench.segments["devices"])
        pictures, wall_others = bench.kills("wall", "framebuffer", bench.new_picture, "devices")
        (came, missing), frames = records.came(), bench.deadlines()
        datas, device_others = bench.kills("devices", "devices", bench.new_data, "wall")
        deadlines, late = (b - a for a, b in zip(frames, bench.deadlines()))
        ready = {role: bench.starts(role) for role in ("wall", "devices")}
    finally:
        bench.close()
    report.text(f"{'ms':32}" + "".join(f"{label:>9}" for label, _ in SHARES))
    kept = row(report, "kill -9 wall to picture", pictures, PICTURE_S)
    kept &= waits(report, "wall", pictures, PICTURE_S)
    kept &= row(report, "kill -9 devices to data", datas, DATA_S)
    kept &= waits(report, "devices", datas, DATA_S)
    for role, times in ready.items():
        kept &= row(report, f"start to READY {role}", times, READY_S)
    late = figures.share_of(late, deadlines, "deadlines of the wall, which did not move,")
    report.text(f"the devices went on at {options.times - len(wall_others)} of {options.times} kills of the "
                f"wall, {missing} of {came} records of the tracker are missing; the wall went on at "
                f"{options.times - len(device_others)} of {options.times} kills of the devices, "
                f"{100 * late:.2f} % of its frames were late")
    report.figure("devices_missed", Measured(len(wall_others), options.times, "kills"), "1")
    report.figure("tracker_records_missing", Measured(missing, came, "records of the tracker"), "1")
    report.figure("wall_missed", Measured(len(device_others), options.times, "kills"), "1")
    report.figure("wall_late", late, "1")
    return kept and not wall_others and not device_others and abs(missing) <= MOST_MISSING


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bin", required=True, help="the folder of merlin and merlind")
    parser.add_argument("--times", type=int, default=100, help="number of kills of each role, and of starts")
    parser.add_argument("--rate", type=float, default=30, help="frame rate of the wall in Hz")
    parser.add_argument("--seed", type=int, default=1, help="seed of the emulated devices")
    parser.add_argument("--json", action="store_true", help="the figures as one JSON object")
    options = parser.parse_args()
    if options.times < 1:
        parser.error("--times is at least 1")
    figures.run_bench("kill", options.json, lambda report: measure(options, report))


if __name__ == "__main__":
    main()
