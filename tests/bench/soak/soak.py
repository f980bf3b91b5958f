#!/usr/bin/env python3
"""./dev soak DURATION: a lab's day in real time, on the real programs. README.md beside this file describes it.

Exit status: 0; 1 if no act explains an event, a fault was not reported, descriptors grow, or memory grows beyond
chance; 1 without figures if the soak did not run; 2 for bad usage.
"""
import argparse
import json
import os
import re
import subprocess
import sys
import time
import urllib.error
import urllib.request

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir))

import chart
import day
import figures
import measures
import roles
from figures import Measured, did_not_run

SAMPLE_S, PROGRESS_S, SETTLE_S = 1, 10, 20  # the last acts are over this long before the end
DESCRIPTORS_S = 10  # time after a start until all descriptors are open
DOWN_S = 5  # time after a restart until a role takes commands
ROLES = ("devices", "wall", "page")
KILLS = ((0.08, "wall"), (0.12, "devices"), (0.16, "wall"), (0.20, "devices"))  # as a share of the soak


class Wall:
    """merlind's devices, wall and page, which we restart, with emulated devices beside them."""

    def __init__(self, options):
        self.place = roles.Place(options, "soak")
        self.disk, self.wrong, self.told = self.place.path("disk"), [], 0
        self.rate = options.rate
        self.place.make_model()
        self.port = roles.free_port()
        self.place.configure({
            "page": {"port": self.port}, "state_file": os.path.join(self.disk, "state.json"),
            "wall": {"snapshots": os.path.join(self.disk, "snapshots"), "snapshots_kept": 3,
                     "rate": {"rate_hz": options.rate},
                     "playlist": {"after_s": 6, "hold_s": 3, "dim_after_s": 10}}})
        self.emulators = {name: roles.Emulator(self.place, name, "visit", options.seed + i, step=True)
                          for i, name in enumerate(roles.DRIVERS)}
        self.programs = {role: self.place.role(role) for role in ROLES}
        self.started = {role: (0, 0.0) for role in ROLES}  # number of starts, and the time of the last one

    def start(self):
        for emulator in self.emulators.values():
            emulator.start()
        for role in ROLES:
            self.restart(role)
            self.programs[role].wait_ready()
        with open(self.place.path(f"{self.place.instance}-page.token"), encoding="utf8") as file:
            self.token = file.read().strip()

    def restart(self, role):
        self.programs[role].start()
        self.started[role] = (self.started[role][0] + 1, time.monotonic())

    def ask(self, path, body=None):
        headers = {"Authorization": f"Bearer {self.token}", "Content-Type": "application/json"}
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}{path}", headers=headers,
                                         data=json.dumps(body).encode() if body else None)
        with urllib.request.urlopen(request, timeout=10) as answer:
            return json.load(answer)

    def command(self, name, argument=None):
        """Sends a command as a person at the page does, who tries again while a role is down for a moment."""
        body = {"command": name} | ({"argument": argument} if argument else {})
        for tries in range(DOWN_S * 5, 0, -1):
            try:
                return self.ask("/api/command", body)
            except urllib.error.HTTPError as error:
                if error.code != 503 or tries == 1:
                    self.wrong.append(f"command {name}: {error}")
                    return None
                time.sleep(0.2)

    def events(self):
        """The events since the last call."""
        answer = self.ask(f"/api/events?since={self.told}")
        self.told = answer["next"] - 1
        return answer["events"]

    def reload(self, patch):
        self.place.write(roles.merged(self.place.config, patch))
        return subprocess.run([f"{self.place.bin}/merlin", "reload", "--instance", self.place.instance],
                              capture_output=True, text=True, check=False)

    def expect_running(self):
        for role, program in self.programs.items():
            if program.process.poll() is not None:
                did_not_run(f"merlind --role {role}",
                            f"it ended by itself, {program.process.returncode}: {program.said()[-500:]}",
                            "its log says why")

    def stop(self):
        for role in reversed(ROLES):
            code = self.programs[role].stop()
            if code != 0:
                self.wrong.append(f"role {role} ended with {code}")
        for emulator in self.emulators.values():
            emulator.stop()


class Soak:
    def __init__(self, options, wall):
        self.options, self.wall = options, wall
        self.day = day.Day(wall, options.seed, options.every)
        self.samples = {role: [] for role in ROLES}
        self.frames, self.segment = measures.Frames(), roles.Segment(wall.place, "wall")
        self.events, self.unexplained = {}, []

    def run(self):
        self.day.explain_devices("start", sorted(self.wall.emulators), due=False)
        for kind, what in (("role", "^the role .* runs$"), ("server", "^page: running$")):
            self.day.explains("start", kind, what)
        self.wall.start()
        begin = time.monotonic()
        quiet_s = 60 if self.options.seconds >= 300 else 0  # the reference for late frames
        self.day.next_at = begin + quiet_s + self.options.every
        self.day.kill_at([(begin + quiet_s + share * self.options.seconds, role) for share, role in KILLS])
        self.day.begin(day.person_commands)  # what the first command opens stays open from now on
        end, sample_at, progress_at = begin + self.options.seconds, begin, begin
        while (now := time.monotonic()) < end:
            self.day.tend(now, may_begin=end - now > SETTLE_S)
            if not self.day.later:  # otherwise a role may be down on purpose
                self.wall.expect_running()
            if now >= sample_at:
                sample_at += SAMPLE_S
                self.sample(now - begin, now)
            if now >= progress_at:
                progress_at += PROGRESS_S
                self.progress(now - begin, end - now)
            time.sleep(0.02)
        self.day.end()
        self.take_events()

    def sample(self, at_s, now):
        for role, program in self.wall.programs.items():
            number, since = self.wall.started[role]
            taken = measures.Sample.of(program.pid, (role, number), at_s, now - since)
            if taken:
                self.samples[role].append(taken)
        if self.segment.reopen() and self.segment.values("wall.deadlines"):
            value = self.segment.value
            self.frames.add(at_s, value("segment.generation"), value("wall.deadlines"), value("wall.late"))
        self.take_events()

    def take_events(self):
        for event in self.wall.events():
            act = self.day.explanation_of(event)
            row = self.events.setdefault(event["kind"], {})
            row[act or "UNEXPLAINED"] = row.get(act or "UNEXPLAINED", 0) + 1
            if act is None:
                self.unexplained.append(f"{event['role']}, {event['kind']}: {event['what']}")
                figures.note(f"  UNEXPLAINED: {self.unexplained[-1]}")

    def progress(self, at_s, left_s):
        newest = {role: all_[-1] for role, all_ in self.samples.items() if all_}
        memory = ", ".join(f"{role} {s.memory_mib:.0f} MiB {s.descriptors} fd" for role, s in newest.items())
        deadlines, late = (sum(m[i] for m in self.frames.minutes) for i in (0, 1))
        count = sum(n for row in self.events.values() for n in row.values())
        figures.note(f"{at_s / 60:6.1f} min, {left_s / 60:.1f} min left: {memory}; late {late} of "
                     f"{deadlines}; {count} events, {len(self.unexplained)} unexplained; "
                     f"{self.day.people.visits} visits")


def report_memory(role, samples, warm_up_s, report):
    """The text for the table, and a list of faults, about the memory of one role."""
    found = measures.memory_slope(samples, warm_up_s)
    if found is None:
        return "too short to be judged", []
    slope, half = found
    report.figure(f"{role}.memory_slope", Measured(slope, len(samples), "samples"), "MiB/h")
    report.figure(f"{role}.memory_slope_half_width", Measured(half, len(samples), "samples"), "MiB/h")
    grew = measures.grew(samples, warm_up_s)
    wrong = [f"{role}: memory grew by {grew:.2f} MiB or more, by {slope:.2f} MiB/h"] if grew else []
    return f"{slope:+9.2f} [{slope - half:+.2f}, {slope + half:+.2f}]", wrong


def report_process(role, samples, options, report):
    """Adds a row to the table; returns a list of faults."""
    if not samples:
        did_not_run(f"merlind --role {role}", "it could not be looked at", "is /proc there?")
    memory, wrong = report_memory(role, samples, options.warm_up, report)
    held = measures.descriptors(samples, DESCRIPTORS_S)
    if held is None:
        did_not_run(f"merlind --role {role}", f"{len(samples)} samples are too few", "soak for longer")
    threads = [s.threads for s in samples]
    report.text(f"{role:8} {samples[-1].memory_mib:7.1f} {memory}".ljust(52)
                + f"{held[0]:4d} -> {held[1]:<4d} {min(threads):3d}..{max(threads):<3d} "
                f"{len({s.life for s in samples}):4d}")
    report.figure(f"{role}.memory", Measured(samples[-1].memory_mib, len(samples), "samples"), "MiB")
    report.figure(f"{role}.descriptors_first", Measured(held[0], len(samples), "samples"), "1")
    report.figure(f"{role}.descriptors_last", Measured(held[1], len(samples), "samples"), "1")
    if held[1] > held[0]:
        wrong.append(f"{role}: descriptors grew from {held[0]} to {held[1]}")
    return wrong


def report_frames(frames, report):
    names = ("first minute", "the rest")
    for name, (deadlines, late) in zip(names, frames.first_and_rest()):
        if deadlines == 0 and name == names[1]:
            continue  # if the soak lasts a minute
        share = figures.share_of(late, deadlines, "deadlines of the wall, which did not move,")
        report.text(f"late frames, {name}: {100 * share:.2f} % of {deadlines}")
        report.figure(f"late_{name.replace(' ', '_')}", share, "1")


def report_events(soak, report):
    report.text("events by kind, and what explains them")
    for kind, row in sorted(soak.events.items()):
        explained = ", ".join(f"{act} {n}" for act, n in sorted(row.items()))
        report.text(f"  {kind:10} {sum(row.values()):5d}  {explained}")
    report.text("acts: " + ", ".join(f"{name.replace('_', ' ')} {n}" for name, n in sorted(soak.day.done.items())))
    count = sum(n for row in soak.events.values() for n in row.values())
    report.figure("events", Measured(count, count, "events"), "1")
    report.figure("events_unexplained", Measured(len(soak.unexplained), count, "events"), "1")
    report.more["events"] = soak.events


def expect_lived(people, done):
    """A day on which nobody came or nothing happened says nothing about the wall."""
    if not people.visits > 0:
        did_not_run("the people", "nobody came", "see day.py")
    if not any(done.get(act.__name__) for act in (*day.ACTS, *day.KILLS.values()) if act is not day.person_commands):
        did_not_run("the day", "no fault and no reload happened", "soak for longer, or with a lower --every")


def measure(options, report):
    wall = Wall(options)
    soak = Soak(options, wall)
    try:
        soak.run()
        wall.stop()
    finally:
        for program in [*wall.programs.values(), *wall.emulators.values()]:
            program.stop()
        soak.day.disk.close()
        if options.keep:
            subprocess.run(["cp", "-r", wall.place.folder, options.keep], check=False)
        wall.place.close()
    expect_lived(soak.day.people, soak.day.done)
    disk = "a file system of its own" if soak.day.disk.mounted else "a limit on the size of its files"
    report.text(f"soak of {options.seconds:.0f} s, seed {options.seed}, {options.rate} Hz; the full disk is {disk}; "
                f"warm-up {options.warm_up:.0f} s after each start")
    report.text("role     MiB last   MiB/h [95 % interval]".ljust(52) + "descriptors threads starts")
    wrong = [w for role in ROLES for w in report_process(role, soak.samples[role], options, report)]
    report_frames(soak.frames, report)
    report_events(soak, report)
    wrong += [f"unexplained event: {event}" for event in soak.unexplained]
    wrong += [f"a fault was not reported: {what}" for what in soak.day.untold()] + wall.wrong
    for what in wrong:
        report.text(f"WRONG: {what}")
        figures.note(f"soak: {what}")
    report.more["wrong"] = wrong
    if options.chart:
        chart.write(options.chart, soak.samples, soak.frames)
        report.text(f"chart: {options.chart}")
    return not wrong


def seconds_of(text):
    match = re.fullmatch(r"(\d+(?:\.\d+)?)([smhd]?)", text)
    if not match or float(match[1]) * {"": 1, "s": 1, "m": 60, "h": 3600, "d": 86400}[match[2]] < 60:
        raise argparse.ArgumentTypeError(f"{text} is not a duration of at least 60s, such as 90s, 10m, 2h, 1d")
    return float(match[1]) * {"": 1, "s": 1, "m": 60, "h": 3600, "d": 86400}[match[2]]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("seconds", metavar="DURATION", type=seconds_of, help="such as 90s, 10m, 2h")
    parser.add_argument("--bin", required=True, help="the folder of merlin and merlind")
    parser.add_argument("--seed", type=int, default=1, help="seed of people, faults and devices")
    parser.add_argument("--rate", type=float, default=30, help="frame rate of the wall in Hz")
    parser.add_argument("--every", type=float, default=15, help="average number of seconds between two acts")
    parser.add_argument("--warm-up", type=float, help="seconds after each start whose memory does not count")
    parser.add_argument("--chart", help="the SVG file to write")
    parser.add_argument("--keep", metavar="FOLDER", help="folder to which logs and configuration are copied")
    parser.add_argument("--json", action="store_true", help="the figures as one JSON object")
    options = parser.parse_args()
    if options.warm_up is None:
        # The flight recorder fills for five minutes, and the first run of each act takes memory.
        options.warm_up = max(300, 2 * len(day.ACTS) * options.every)
    figures.run_bench("soak", options.json, lambda report: measure(options, report))


if __name__ == "__main__":
    main()
