"""Cases: clients that have no permission to send commands. Each attacks the wall's encrypted address for
commands or its local sockets, and in turn a sink. It must get no answer, and no more frames may be late than
beside the sink."""
import copy
import json
import os
import socket
import struct
import subprocess
import sys
import time

import figures
import sockets
import strangers
from devices import FLOODER, RATE_HZ, free_port
from figures import Measured, did_not_run, mean_of
from wall import WAY_OUT, Children, Wall, wait_for

LIMIT = 1.0  # percentage points of late frames beyond those of the worst turn on a sink
SERVER = "commands of the wall over the network"
BLANK = json.dumps({"command": "blank"}).encode()
OTHER_USER = 65534
CONNECTIONS = 10_000


def key(options, name):
    """Makes a key pair; returns its file."""
    path = os.path.join(options.folder, f"{name}.keys")
    if not os.path.exists(path):
        public = figures.run([f"{options.bin}/merlin", "keys", "-o", path], "merlin keys", WAY_OUT)
        with open(path + ".public", "w", encoding="utf8") as file:
            file.write(public[:40] + "\n")
    return path


class Attacked:
    """A wall that accepts commands over the network from one key, and its addresses."""

    def __init__(self, options):
        self.options = options
        self.server, self.listed, self.other = (key(options, n) for n in ("wall", "boss", "other"))
        self.address = ("127.0.0.1", free_port())
        self.wall = Wall(options, None, {"serve": {
            "wall_endpoint": "tcp://%s:%d" % self.address, "commands_keys": self.server,
            "commands_clients": self.listed + ".public"}})
        self.local = os.path.join(options.folder, f"{self.wall.instance}-wall.command")

    def on_sinks(self):
        """The same attacker's data with the addresses of sinks, which only read a client's first bytes and
        close the connection."""
        sinks = copy.copy(self)
        sinks.address = ("127.0.0.1", free_port())
        sinks.local = os.path.join(self.options.folder, "sink")
        return sinks

    def merlin(self, keys, *words):
        return subprocess.run(
            [f"{self.options.bin}/merlin", "--endpoint", "tcp://%s:%d" % self.address, "--keys", keys,
             "--server-key", self.server + ".public", *words], capture_output=True, text=True,
            check=False)


# Each of these functions attacks until `end`. It returns the number of attempts, and the bytes that came
# beyond a server's greeting.

def no_key(attacked, end):
    """A client without encryption, which speaks the protocol of commands."""
    tries, got = 0, b""
    while time.monotonic() < end:
        s = strangers.connect(attacked.address)
        strangers.send(s, strangers.GREETING + strangers.ready(b"REQ") + b"\1\0\0"
                       + bytes([len(BLANK)]) + BLANK)
        got += received(s)
        tries += 1
    return tries, got


def wrong_key(attacked, end):
    """merlin with a key of its own that is not in the list."""
    tries, got = 0, b""
    while time.monotonic() < end or tries == 0:
        asked = attacked.merlin(attacked.other, "blank")
        got += b"a command" if asked.returncode == 0 else b""
        tries += 1
    return tries, got


def other_user(attacked, end):
    """Another user of the same machine, who is in none of the daemon's groups."""
    if os.geteuid() != 0:
        did_not_run("another user", "only root can become one", "run this as root")
    os.chmod(attacked.options.folder, 0o755)
    knock = ("import errno, os, socket, sys, time\n"
             f"os.setgroups([]); os.setgid({OTHER_USER}); os.setuid({OTHER_USER})\n"
             "tries, opened, others, end = 0, 0, 0, float(sys.argv[2])\n"
             "while tries == 0 or time.monotonic() < end:\n"
             "    s = socket.socket(socket.AF_UNIX)\n"
             "    error = s.connect_ex(sys.argv[1])\n"
             "    opened += error == 0; others = others or error * (error not in (0, errno.EACCES))\n"
             "    s.close(); tries += 1; time.sleep(0.001)\n"
             "print(tries, opened, others)\n")
    said = figures.run([sys.executable, "-c", knock, attacked.local, str(end)], "another user", WAY_OUT)
    tries, opened, other = map(int, said.split())
    if other:  # no such socket, for example, which keeps nobody out
        did_not_run("another user", f"{attacked.local}: {os.strerror(other)} instead of no permission", "see control.py")
    return tries, b"a connection" * opened


def connections(attacked, end):
    """10,000 connections, 200 at a time. Each sends a greeting if that is possible at once, and then nothing."""
    tries, held = 0, []
    pause = max(0, end - time.monotonic()) * 200 / CONNECTIONS
    while tries < CONNECTIONS:
        s = socket.socket()
        s.setblocking(False)  # the client does not wait for a server that accepts no more connections now
        s.connect_ex(attacked.address)
        try:
            s.send(strangers.CURVE_GREETING)
        except OSError:
            pass
        held.append(s)
        tries += 1
        if len(held) == 200:
            time.sleep(pause)
            strangers.close(held)
            held = []
    return tries, b""


def gigabyte(attacked, end):
    """Messages that declare 1 GB; sends as much of it as the server reads."""
    tries, got, zeros = 0, b"", bytes(1 << 16)
    while time.monotonic() < end:
        for greeting in (strangers.GREETING + strangers.ready(b"REQ"), strangers.CURVE_GREETING):
            s = strangers.connect(attacked.address)
            strangers.send(s, greeting + b"\2" + struct.pack(">Q", 10**9))
            strangers.push(s, zeros, 0.2)
            got += received(s)
            tries += 1
        time.sleep(0.05)
    return tries, got


def half_a_message(attacked, end):
    """The greeting, then half of a frame, then nothing."""
    tries, got, held = 0, b"", []
    while time.monotonic() < end:
        s = strangers.connect(attacked.address)
        strangers.send(s, strangers.CURVE_GREETING + b"\4\xc8\5HELLO" + bytes(60))
        held.append(s)
        tries += 1
        time.sleep(0.05)
    for s in held:
        got += received(s)
    return tries, got


def received(s):
    """Returns the bytes beyond the greeting (64 bytes) that come until the other side closes, or for 20 ms;
    closes."""
    if s is None:
        return b""
    data = b""
    try:
        s.settimeout(0.02)
        while part := s.recv(4096):
            data += part
    except OSError:
        pass
    s.close()
    return data[64:]


def met(status):
    """How many connections the attacked server has taken or refused so far."""
    server = status["servers"][SERVER]
    return server["accepted"] + server["refused"]


def expect_reached(attacker, tries, clients):
    """Each attacker has to reach merlind, or that it got nothing says nothing. `clients`: how many merlind met
    meanwhile. The one of another user stops at the socket's permissions, which it looks at itself."""
    if not tries > 0:
        did_not_run(attacker.__name__, "it did not try", "see control.py")
    if attacker is not other_user and not clients > 0:
        did_not_run(attacker.__name__, f"none of its {tries} tries reached merlind", "see control.py")


class Unauthorised:
    """Runs each attacker in turns on sinks and on merlind, in the order ABBA."""
    name = "unauthorised"
    ATTACKERS = (no_key, wrong_key, other_user, connections, gigabyte, half_a_message)

    def run(self, options, report):
        attacked, wrong = Attacked(options), []
        with attacked.wall as wall:
            self.expect_served(attacked)
            time.sleep(3)  # by now the governor knows the machine
            for attacker in self.ATTACKERS:
                if not self.bears(attacked, attacker, report):
                    wrong.append(attacker.__name__)
            assert wall.status()["shown"] == "picture", "a command of somebody else was carried out"
            self.expect_served(attacked)
            sockets.expect_sound(wall)
        sockets.expect_clean_end(wall)
        assert not wrong, f"late frames: {', '.join(wrong)}"

    def bears(self, attacked, attacker, report):
        """Whether no more frames are late than in the worst turn on sinks, plus LIMIT. The worst turn counts,
        since turns differ by themselves on a machine that also does something else."""
        options, tries, turns = attacked.options, 0, {"sink": [], "merlind": []}
        before = met(attacked.wall.status())
        for turn in range(2 * options.rounds):
            side = ("sink", "merlind")[(turn + turn // 2) % 2]  # ABBA
            share, (tried, got) = self.turn(attacked, attacker, side)
            turns[side].append(share)
            if side == "merlind":
                tries += tried
                assert not got, f"{attacker.__name__}: it got {got[:80]}"
        expect_reached(attacker, tries, met(attacked.wall.status()) - before)
        name, worst = f"{self.name}.{attacker.__name__}", max(turns["sink"])
        sink, late = (mean_of(turns[side], "turns") for side in ("sink", "merlind"))
        figures.note(f"{name}: {tries} tries")
        report.text(f"{name:28} {tries:6d} tries: got nothing; late {late:5.2f} % beside {sink:.2f} % "
                    f"of the sink ({late - sink:+.2f} points; the sink's worst turn {worst:.2f} %)")
        for side in turns:
            report.figure(f"{name}.{side}.late", mean_of(turns[side], "turns"), "%")
        return late <= worst + LIMIT

    def turn(self, attacked, attacker, side):
        options, result = attacked.options, []
        with Children() as children:
            at = attacked
            if side == "sink":
                at = attacked.on_sinks()
                for place in (str(at.address[1]), at.local):
                    children.start([sys.executable, FLOODER, "answer", place])
                wait_for(at.local)
            end = time.monotonic() + options.seconds
            share = self.late(attacked.wall, options.seconds, lambda: result.extend(attacker(at, end)))
        return share, result

    def late(self, wall, seconds, work):
        """Share of late deadlines while `work` runs, which lasts at least `seconds`."""
        began, before = time.monotonic(), wall.deadlines()
        work()
        time.sleep(max(0, began + seconds - time.monotonic()))
        took, after = time.monotonic() - began, wall.deadlines()
        # Relative to the configured rate: a wall that has halved its rate misses every second frame.
        asked = RATE_HZ * took
        deadlines, late = (b - a for a, b in zip(before, after))
        if deadlines < asked / 8:
            did_not_run("the wall", f"it did not move: {deadlines} deadlines of {asked:.0f}",
                        "the emulated ball turns it")
        return Measured(max(0, 100 * (1 - (deadlines - late) / asked)), deadlines, "deadlines")

    def expect_served(self, attacked):
        """Checks that the listed key is answered, so that the address is known to be served before and after
        the attack."""
        asked = attacked.merlin(attacked.listed, "status", "--json")
        if asked.returncode != 0:
            did_not_run("the listed key", f"it was not answered: {asked.stderr[-300:]}", WAY_OUT)


CASES = [Unauthorised()]
