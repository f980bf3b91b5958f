"""Cases: lines that flood, compared with the same flooders on sinks that block them in the same way."""
import os
import socket
import sys
import time

from figures import did_not_run, mean_of, note, Measured
from wall import Children, Wall, wait_for

FLOODER = os.path.join(os.path.dirname(__file__), "flooder.py")
LIMIT = 1.0  # percentage points of late frames beyond those beside the sinks
SEE = "see merlin status and tests/bench/attack/flooder.py"
RATE_HZ = 30  # of the demo's wall
TCP_RATE, SERIAL_RATE = 1_000_000, 4 * 38400 / 10  # bytes a second that merlind reads


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Flood:
    """A flood. `kind`: tcp or pty; each of `devices` gets a flooder that sends `data`."""

    def __init__(self, name, kind, devices, data, ball_garbage=0):
        self.name, self.kind, self.devices, self.data = name, kind, devices, data
        self.ball_garbage = ball_garbage

    def run(self, options, report):
        results = {"sink": [], "merlind": []}
        for turn in range(2 * options.rounds):
            side = ("sink", "merlind")[(turn + turn // 2) % 2]  # ABBA
            results[side].append(self.turn(options, side))
            late, cores = results[side][-1]
            note(f"{self.name}: turn {turn + 1} of {2 * options.rounds}")
            report.text(f"{self.name:16} {side:8} late {late:6.2f} %  merlind {cores:5.2f} cores")
        mean = {side: mean_of((late for late, _ in all_), f"turns of {self.name}")
                for side, all_ in results.items()}
        cores = {side: mean_of((c for _, c in all_), "turns") for side, all_ in results.items()}
        more = mean["merlind"] - mean["sink"]
        report.text(f"{self.name:16} late {mean['merlind']:.2f} % beside {mean['sink']:.2f} % of the "
                    f"sinks: {more:+.2f} points (at most {LIMIT:+.1f}); merlind takes "
                    f"{cores['merlind'] - cores['sink']:+.2f} cores more")
        for side in results:
            deadlines = sum(late.count for late, _ in results[side])
            report.figure(f"{self.name}.{side}.late",
                          Measured(mean[side], deadlines, "deadlines"), "%")
            report.figure(f"{self.name}.{side}.cores", cores[side], "1")
        assert more <= LIMIT, f"{more:+.2f} percentage points of late frames"

    def turn(self, options, side):
        lines, targets, ball = {}, {}, os.path.join(options.folder, "ball")
        for device in self.devices:
            at = free_port() if self.kind == "tcp" else os.path.join(options.folder, device)
            targets[device] = f"{self.kind}:{at}"
            lines[device] = f"tcp://127.0.0.1:{at}" if self.kind == "tcp" else f"pty:{at}"
        with Children() as children:
            for device, target in targets.items():
                children.start([sys.executable, FLOODER, "send", target, self.data])
                if self.kind == "pty":
                    wait_for(target[4:])
                if side == "sink":
                    rate = TCP_RATE if self.kind == "tcp" else SERIAL_RATE
                    children.start([sys.executable, FLOODER, "sink", target, str(rate)])
            emulator = [f"{options.bin}/merlin", "emulate", "spaceball", "--script", "turning",
                        "--link", ball]
            if self.ball_garbage and side == "merlind":
                emulator += ["--garbage-every", str(self.ball_garbage)]
            children.start(emulator)
            wait_for(ball)
            ports = {"ball": f"pty:{ball}"} | (lines if side == "merlind" else {})
            with Wall(options, ports) as wall:
                return self.measure(options, wall, side)

    def measure(self, options, wall, side):
        time.sleep(3)  # by now the governor knows the machine and the floods have begun
        began, before, cores = time.monotonic(), wall.deadlines(), wall.cores()
        time.sleep(options.seconds)
        after, cores = wall.deadlines(), wall.cores() - cores
        # Relative to the configured rate: a wall that has halved its rate misses every second frame.
        asked = RATE_HZ * (time.monotonic() - began)
        deadlines, late = (b - a for a, b in zip(before, after))
        status = wall.status()
        if not status["moving"] or deadlines < asked / 8:
            did_not_run("the wall", f"it did not move: {deadlines} deadlines of {asked:.0f}",
                        "the emulated ball turns it")
        if side == "merlind":
            self.expect_flooded(status)
        share = max(0, 100 * (1 - (deadlines - late) / asked))
        return Measured(share, deadlines, "deadlines"), cores / options.seconds

    def expect_flooded(self, status):
        """Checks that the attack reached merlind: the health of each flooded line reports it, and the ball works."""
        health = status["devices"]
        for device in self.devices:
            if "sends more than" not in health[device].get("reason", ""):
                did_not_run("the flood", f"the {device} was not flooded: {health[device]}", SEE)
        if health["ball"]["health"] != "ok":
            did_not_run("the ball", f"it is not well: {health['ball']}", SEE)
        if self.ball_garbage and not health["ball"].get("bad_bytes", 0) > 0:
            did_not_run("the garbage", f"the ball sent none: {health['ball']}", SEE)


CASES = [
    Flood("tcp-flood", "tcp", ("glove", "tracker"), "noise"),
    Flood("pty-newlines", "pty", ("tracker",), "newlines"),
    Flood("line-garbage", "pty", ("glove", "tracker"), "noise", ball_garbage=2),
]
