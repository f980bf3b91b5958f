"""Cases: lines that flood, beside the same flooders on sinks that block them the same way."""
import os
import socket
import statistics
import sys
import time

from wall import Children, Wall, wait_for

FLOODER = os.path.join(os.path.dirname(__file__), "flooder.py")
LIMIT = 1.0  # percentage points of late frames above those beside the sinks
RATE_HZ = 30  # of the demo's wall
TCP_RATE, SERIAL_RATE = 1_000_000, 4 * 38400 / 10  # bytes a second that merlind reads


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Flood:
    """`kind`: tcp or pty; each of `devices` gets one flooder of `data`."""

    def __init__(self, name, kind, devices, data, ball_garbage=0):
        self.name, self.kind, self.devices, self.data = name, kind, devices, data
        self.ball_garbage = ball_garbage

    def run(self, options):
        results = {"sink": [], "merlind": []}
        for turn in range(2 * options.rounds):
            side = ("sink", "merlind")[(turn + turn // 2) % 2]  # ABBA
            results[side].append(self.turn(options, side))
            late, cores = results[side][-1]
            print(f"{self.name:16} {side:8} late {late:6.2f} %  merlind {cores:5.2f} cores",
                  flush=True)
        mean = {side: statistics.mean(late for late, _ in all_) for side, all_ in results.items()}
        cores = {side: statistics.mean(c for _, c in all_) for side, all_ in results.items()}
        more = mean["merlind"] - mean["sink"]
        print(f"{self.name:16} late {mean['merlind']:.2f} % beside {mean['sink']:.2f} % of the "
              f"sinks: {more:+.2f} points (at most {LIMIT:+.1f}); merlind takes "
              f"{cores['merlind'] - cores['sink']:+.2f} cores more", flush=True)
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
        time.sleep(3)  # the governor has learnt, the floods have begun
        began, before, cores = time.monotonic(), wall.deadlines(), wall.cores()
        time.sleep(options.seconds)
        after, cores = wall.deadlines(), wall.cores() - cores
        # Of the rate that is asked: a wall that has halved its rate has missed every second frame.
        asked = RATE_HZ * (time.monotonic() - began)
        deadlines, late = (b - a for a, b in zip(before, after))
        status = wall.status()
        assert status["moving"] and deadlines >= asked / 8, \
            f"the wall did not move: {deadlines} deadlines of {asked:.0f}"
        if side == "merlind":
            self.expect_flooded(status)
        return max(0, 100 * (1 - (deadlines - late) / asked)), cores / options.seconds

    def expect_flooded(self, status):
        """That the attack reached merlind: each line's health says so, and the ball is well."""
        health = status["devices"]
        for device in self.devices:
            reason = health[device].get("reason", "")
            assert "sends more than" in reason, f"the {device} was not flooded: {health[device]}"
        assert health["ball"]["health"] == "ok", f"the ball is not well: {health['ball']}"
        if self.ball_garbage:
            bad = health["ball"].get("bad_bytes", 0)
            assert bad > 0, f"the ball sent no garbage: {health['ball']}"


CASES = [
    Flood("tcp-flood", "tcp", ("glove", "tracker"), "noise"),
    Flood("pty-newlines", "pty", ("tracker",), "newlines"),
    Flood("line-garbage", "pty", ("glove", "tracker"), "noise", ball_garbage=2),
]
