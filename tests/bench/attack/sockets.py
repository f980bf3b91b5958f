"""Cases: strangers on every socket of one merlind, and the same for ten minutes as a soak."""
import os
import re
import sys
import threading
import time

import figures
import strangers
from devices import FLOODER, Flood, free_port
from figures import Measured, did_not_run
from wall import WAY_OUT, Children, Wall

MOST_MORE_MB = 8  # resident memory beyond that after the first round
MOST_WAIT_S = 5  # longest time of `merlin status` while strangers hold every place
ATTACKED = ("commands of the wall", "topics of the devices", "samples for other machines", "VRPN",
            "space mouse")
FAULT = re.compile(r"ERROR: \w+Sanitizer|runtime error|WARNING: ThreadSanitizer")


def attacked(options):
    """A wall with all servers and emulated devices, and the servers' addresses."""
    keys = []
    for name in ("server", "client"):
        path = os.path.join(options.folder, f"{name}.keys")
        if not os.path.exists(path):
            public = figures.run([f"{options.bin}/merlin", "keys", "-o", path], "merlin keys", WAY_OUT)
            with open(path + ".public", "w", encoding="utf8") as file:
                file.write(public[:40] + "\n")
        keys.append(path)
    vrpn, samples = free_port(), free_port()
    spnav = os.path.join(options.folder, "spnav.sock")
    wall = Wall(options, None, {"serve": {
        "vrpn_port": vrpn, "spnav_socket": spnav, "samples_endpoint": f"tcp://127.0.0.1:{samples}",
        "samples_keys": keys[0], "samples_clients": keys[1] + ".public"}})
    return wall, strangers.Target(options.folder, wall.instance, vrpn, samples, spnav)


class Held:
    """The resources that a process holds."""

    def __init__(self, pid):
        self.descriptors = len(os.listdir(f"/proc/{pid}/fd"))
        self.threads = len(os.listdir(f"/proc/{pid}/task"))
        with open(f"/proc/{pid}/status", encoding="utf8") as file:
            self.mb = int(re.search(r"VmRSS:\s+(\d+)", file.read())[1]) / 1024

    def __str__(self):
        return f"{self.descriptors} descriptors, {self.threads} threads, {self.mb:.0f} MB"


def settled(wall):
    """Waits until the attackers' connections are gone, which time out within seconds; returns what is held then."""
    best = Held(wall.process.pid)
    for _ in range(30):
        time.sleep(0.5)
        held = Held(wall.process.pid)
        if held.descriptors < best.descriptors:
            best = held
        elif held.descriptors == best.descriptors and sum(wall.connections()) <= 2:
            return held
    return best


def attack(wall, target, stranger):
    """Performs one attack, and runs `merlin status` during it and afterwards. Returns what the attack did in
    words, the longest wait, and the resident memory at that time."""
    said = []
    thread = threading.Thread(target=lambda: said.append(stranger(target)))
    thread.start()
    waits, mb = [], 0
    while True:
        running = thread.is_alive()
        began = time.monotonic()
        wall.status()
        waits.append(time.monotonic() - began)
        mb = max(mb, Held(wall.process.pid).mb)
        assert waits[-1] <= MOST_WAIT_S, f"{stranger.__name__}: merlin status took {waits[-1]:.1f} s"
        if not running:
            break
        time.sleep(0.2)
    thread.join()
    if not said:
        did_not_run(f"the attack {stranger.__name__}", "its thread failed", "see strangers.py")
    return said[0], max(waits), mb


def expect_sent_away(status):
    """Checks that the attacks reached every server: each reports that it has closed a stranger's connection."""
    for name in ATTACKED:
        if not sent_away(status, name) > 0:
            did_not_run(f"the attack on {name}", f"it did not reach it: {status['servers'][name]}",
                        "see strangers.py")


def sent_away(status, name):
    server = status["servers"][name]
    return sum(server[kind] for kind in ("broken", "refused", "replaced", "silent", "slow"))


def is_sanitized(wall):
    with open(f"/proc/{wall.process.pid}/maps", encoding="utf8") as file:
        return re.search(r"lib[at]san", file.read()) is not None


def expect_sound(wall):
    fault = FAULT.search(wall.said())
    assert not fault, f"merlind said: {wall.said()[fault.start():][:2000]}"
    assert wall.process.poll() is None, f"merlind ended: {wall.said()[-500:]}"


class Sockets:
    name = "sockets"

    def run(self, options, report):
        wall, target = attacked(options)
        with wall:
            held = [settled(wall)]
            for turn in range(1 + options.rounds):  # the first round only warms up
                for stranger in strangers.ALL:
                    said, wait, mb = attack(wall, target, stranger)
                    if turn == 1:
                        report.text(f"{self.name:16} {said}: merlin status within {wait:.2f} s, "
                                    f"{mb:.0f} MB")
                        report.figure(f"{self.name}.{stranger.__name__}.status_wait",
                                      Measured(wait, 1, "attacks"), "s")
                held.append(settled(wall))
                figures.note(f"{self.name}: round {turn} of {options.rounds}")
                report.text(f"{self.name:16} round {turn}: {held[-1]}")
            expect_sent_away(wall.status())
            expect_sound(wall)
            warm, last = held[1], held[-1]
            report.figure(f"{self.name}.more_memory", Measured(last.mb - warm.mb, options.rounds,
                                                               "rounds"), "MiB")
            assert last.descriptors <= warm.descriptors, f"descriptors: {warm}, then {last}"
            assert last.threads <= warm.threads, f"threads: {warm}, then {last}"
            # A sanitizer keeps freed memory for a while.
            assert is_sanitized(wall) or last.mb <= warm.mb + MOST_MORE_MB, \
                f"memory: {warm}, then {last}"
            began = time.monotonic()
        expect_clean_end(wall)
        report.text(f"{self.name:16} from {warm} to {last}; stopped in "
                    f"{time.monotonic() - began:.1f} s")


def expect_clean_end(wall):
    code = wall.process.returncode
    assert code == 0, f"merlind ended with {code}"
    fault = FAULT.search(wall.end)
    assert not fault, f"merlind said: {wall.end[fault.start():][:2000]}"


class Soak:
    """Repeats all attacks while the devices' samples are counted. Runs only if it is named on the command line."""
    name, by_name_only = "soak", True
    RATES = {"glove": 100.0, "tracker1": 120.0}  # the emulators'

    def run(self, options, report):
        wall, target = attacked(options)
        with wall:
            time.sleep(3)
            began, before = time.monotonic(), self.counts(wall)
            late_before, attacks = wall.deadlines(), 0
            while time.monotonic() - began < options.soak_seconds:
                stranger = strangers.ALL[attacks % len(strangers.ALL)]
                attack(wall, target, stranger)
                attacks += 1
                if attacks % len(strangers.ALL) == 0:
                    figures.note(f"{self.name}: {attacks} attacks")
            took, after = time.monotonic() - began, self.counts(wall)
            deadlines, late = (b - a for a, b in zip(late_before, wall.deadlines()))
            expect_sent_away(wall.status())
            expect_sound(wall)
        expect_clean_end(wall)
        for name, rate in self.RATES.items():
            seconds = after[name][1] - before[name][1]
            count = after[name][0] - before[name][0]
            hz = Measured(count / seconds if count else 0, count, f"samples of {name}")
            missing = round(seconds * rate) - count
            report.text(f"{self.name:16} {name}: {count} samples in {seconds:.1f} s, "
                        f"{hz:.2f} Hz, {missing} missing")
            report.figure(f"{self.name}.{name}.rate", hz, "Hz")
            assert abs(missing) <= 2, f"{name}: samples are missing"
        share = figures.share_of(late, deadlines, "deadlines of the wall, which did not move,")
        report.text(f"{self.name:16} {attacks} attacks in {took:.0f} s; late {100 * share:.2f} % of "
                    f"{deadlines} deadlines")
        report.figure(f"{self.name}.late", share, "1")

    def counts(self, wall):
        """For each device: the number of its newest sample, and the time of that sample in seconds."""
        names = [f"{device}.{field}" for device in self.RATES for field in ("counter", "received_ns")]
        values = wall.fields("devices", *names)
        return {device: (values[f"{device}.counter"], values[f"{device}.received_ns"] / 1e9)
                for device in self.RATES}


class Knocking(Flood):
    """A stranger who connects, sends noise until the server closes the connection, and connects again at once."""

    def __init__(self, name, server, place):
        super().__init__(name, "socket", (), "noise")
        self.server, self.place = server, place

    def turn(self, options, side):
        wall, target = attacked(options)
        with Children() as children, wall:
            at = getattr(target, self.place)
            path = os.path.join(options.folder, "sink")
            if side == "sink":
                at = path if isinstance(at, str) else (at[0], free_port())
            where = at if isinstance(at, str) else str(at[1])
            if side == "sink":
                children.start([sys.executable, FLOODER, "answer", where])
            children.start([sys.executable, FLOODER, "knock", where, self.data])
            return self.measure(options, wall, side)

    def expect_flooded(self, status):
        if not sent_away(status, self.server) > 0:
            did_not_run(f"the flood of {self.server}",
                        f"it did not reach it: {status['servers'][self.server]}", "see flooder.py")


CASES = [Knocking("knock-commands", "commands of the wall", "commands"),
         Knocking("knock-vrpn", "VRPN", "vrpn"), Sockets(), Soak()]
