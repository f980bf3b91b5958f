"""merlind's roles as processes of their own, beside emulated devices that outlive them, as real devices do; and
access to their shared memory. Uses Python's standard library alone."""
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time

import figures
from figures import did_not_run

SOURCE = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(SOURCE, "daemon", "shm"))
import read_merlin  # noqa: E402

WAY_OUT = "./dev builds merlind and merlin"
DRIVERS = {"glove": "cyberglove", "tracker": "fastrak", "ball": "spaceball"}
READY_S = 60  # enough for a loaded machine with a cold cache of shaders


def wait_until(condition, seconds, subject, found, step=0.02):
    """Ends the benchmark unless `condition` becomes true within `seconds`."""
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            did_not_run(subject, found() if callable(found) else found, WAY_OUT)
        time.sleep(step)


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Program:
    """A process whose output goes into a file. The file outlives the process and is used by its successors."""

    def __init__(self, command, log, environment=None, stdin=subprocess.DEVNULL):
        self.command, self.log = [str(word) for word in command], log
        self.environment, self.stdin, self.process, self.begin = environment, stdin, None, 0

    def start(self):
        self.begin = os.path.getsize(self.log) if os.path.exists(self.log) else 0
        with open(self.log, "a", encoding="utf8") as log:
            self.process = subprocess.Popen(self.command, stdin=self.stdin, stdout=log, stderr=log,
                                            env=os.environ | (self.environment or {}))
        return self

    @property
    def pid(self):
        return self.process.pid

    def said(self):
        """The output since the last start."""
        with open(self.log, encoding="utf8", errors="replace") as file:
            file.seek(self.begin)
            return file.read()

    def wait_ready(self):
        def ready():
            if self.process.poll() is not None:
                did_not_run(self.command[0], f"it ended: {self.said()[-500:]}", WAY_OUT)
            return "ready" in self.said()
        wait_until(ready, READY_S, self.command[0], lambda: f"not ready: {self.said()[-500:]}")

    def kill(self):
        self.process.kill()
        self.process.wait()

    def stop(self):
        """Ends the process; returns its exit status, -9 if it had not ended after 20 s."""
        if self.process is None:
            return 0
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        try:
            return self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.kill()
            return -9


class Emulator(Program):
    """A device on a pseudo-terminal. With `step`, each phase of its person lasts until next() is called."""

    def __init__(self, place, name, script, seed, step=False):
        self.name, self.link = name, os.path.join(place.folder, f"{name}.pty")
        command = [f"{place.bin}/merlin", "emulate", DRIVERS[name], "--script", script, "--link", self.link,
                   "--seed", seed]
        super().__init__(command + (["--step"] if step else []), place.path(f"{name}.log"),
                         stdin=subprocess.PIPE if step else subprocess.DEVNULL)

    def start(self):
        if os.path.islink(self.link):
            os.unlink(self.link)
        super().start()
        wait_until(lambda: os.path.islink(self.link), 10, self.command[1], "it made no link")
        return self

    def next(self):
        self.process.stdin.write(b"\n")
        self.process.stdin.flush()


class Place:
    """A folder for one instance: configuration, model, logs. It is removed at the block's end."""

    def __init__(self, options, name):
        self.bin, self.instance = options.bin, f"merlin-{name}-{os.getpid()}"
        if not os.access(f"{self.bin}/merlind", os.X_OK):
            did_not_run(f"{self.bin}/merlind", "there is no such program", WAY_OUT)
        self.temporary = tempfile.TemporaryDirectory(prefix=f"merlin-{name}-")
        self.folder = self.temporary.name
        self.model, self.config_file = self.path("model.mrm"), self.path("merlin.json")
        self.config = {}

    def path(self, name):
        return os.path.join(self.folder, name)

    def make_model(self):
        scan = os.path.join(SOURCE, "config/models/ankylosaurus.ply")
        figures.run([f"{self.bin}/merlin", "mesh", "reduce", scan, "-o", self.model], "the model", WAY_OUT)

    def configure(self, also):
        """Writes the demo's configuration with devices on our pseudo-terminals, and `also` merged over its
        objects."""
        with open(os.path.join(SOURCE, "config/demo.json"), encoding="utf8") as file:
            config = json.load(file)
        for key in ("$schema", "script"):
            config.pop(key)
        config["postures"]["file"] = os.path.join(SOURCE, "config/postures.json")
        config |= {"instance": self.instance, "run_directory": self.folder,
                   "state_file": self.path("state.json"),
                   "devices": [{"name": name, "driver": driver, "port": f"pty:{self.path(name)}.pty"}
                               for name, driver in DRIVERS.items()]}
        config["wall"]["model"] = self.model
        self.write(merged(config, also))
        self.config = merged(config, also)

    def write(self, config):
        with open(self.config_file + ".new", "w", encoding="utf8") as file:
            json.dump(config, file)
        os.rename(self.config_file + ".new", self.config_file)

    def role(self, role, environment=None):
        return Program([f"{self.bin}/merlind", "--config", self.config_file, "--role", role],
                       self.path(f"{role}.log"), environment)

    def close(self):
        self.temporary.cleanup()
        for name in os.listdir("/dev/shm"):  # those of a role that was killed
            if name.startswith(self.instance):
                os.unlink(f"/dev/shm/{name}")


def merged(base, patch):
    """A copy of a JSON object over which another one is merged; objects are merged key by key."""
    result = dict(base)
    for key, value in patch.items():
        both = isinstance(value, dict) and isinstance(base.get(key), dict)
        result[key] = merged(base[key], value) if both else value
    return result


class Segment:
    """The present shared memory of a role. Call `reopen()` after the role was restarted."""

    def __init__(self, place, role):
        self.name = f"{place.instance}-{role}"
        self.memory, self.table, self.made = None, {}, None

    def reopen(self):
        """Whether the segment exists and is complete; opens it if it is another one than before."""
        try:
            made = os.stat(f"/dev/shm/{self.name}")
            if self.made == (made.st_ino, made.st_ctime_ns) and self.memory:
                return True
            self.memory, self.table = read_merlin.open_segment(self.name)
        except (OSError, ValueError, SystemExit, read_merlin.struct.error):
            self.memory = None  # the role is just making it
            return False
        self.made = (made.st_ino, made.st_ctime_ns)
        return True

    def values(self, field):
        """All values of a field; None before the first."""
        if not self.memory or field not in self.table:
            return None
        return read_merlin.read(self.memory, *self.table[field][1])

    def value(self, field, otherwise=0):
        found = self.values(field)
        return found[0] if found else otherwise
