"""A real merlind whose wall moves, and its figures."""
import json
import os
import signal
import subprocess
import sys
import time

import figures
from figures import did_not_run

WAY_OUT = "'./dev bench attack' builds merlind and merlin"


def make_model(options):
    """Makes the demo's model, once in each run."""
    if os.path.exists(options.model):
        return
    scan = os.path.join(options.source, "config/models/ankylosaurus.ply")
    figures.run([f"{options.bin}/merlin", "mesh", "reduce", scan, "-o", options.model], "the model",
                WAY_OUT)


class Wall:
    """merlind with a configuration of its own. `lines`: the ports of glove, tracker and ball; None: emulated
    devices with a ball that turns."""

    def __init__(self, options, lines, also=None):
        make_model(options)
        self.options, self.instance = options, f"merlin-attack-{os.getpid()}"
        with open(os.path.join(options.source, "config/demo.json"), encoding="utf8") as file:
            config = json.load(file)
        config.pop("$schema")
        config["instance"], config["run_directory"] = self.instance, options.folder
        config["wall"]["model"] = options.model
        config.pop("postures", None)  # refers to a file beside the demo's configuration
        if lines is None:
            config["script"] = "turning"
        else:
            drivers = {"glove": "cyberglove", "tracker": "fastrak", "ball": "spaceball"}
            config["devices"] = [{"name": name, "driver": driver, "port": lines.get(name, "")}
                                 for name, driver in drivers.items()]
        config.update(also or {})
        path = os.path.join(options.folder, "attack.json")
        with open(path, "w", encoding="utf8") as file:
            json.dump(config, file)
        self.log = open(os.path.join(options.folder, "merlind.log"), "w+", encoding="utf8")
        emulate = ["--emulate"] if lines is None else []
        self.process = subprocess.Popen([f"{options.bin}/merlind", "--config", path, *emulate],
                                        stdout=self.log, stderr=self.log)
        self.end = ""  # merlind's whole output, once it has ended

    def __enter__(self):
        deadline = time.monotonic() + 60
        while "ready" not in self.said():
            if self.process.poll() is not None:
                did_not_run("merlind", f"it ended: {self.said()[-500:]}", WAY_OUT)
            if time.monotonic() > deadline:
                self.process.kill()
                did_not_run("merlind", f"it is not ready: {self.said()[-500:]}", WAY_OUT)
            time.sleep(0.05)
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGTERM)
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            raise AssertionError("merlind did not obey SIGTERM within 20 s") from None
        finally:
            self.end = self.said()
            self.log.close()

    def said(self):
        self.log.flush()
        with open(self.log.name, encoding="utf8", errors="replace") as file:
            return file.read()

    def fields(self, role, *names):
        """The values of these fields in the shared memory, which are whole numbers."""
        reader = os.path.join(self.options.source, "daemon/shm/read_merlin.py")
        output = figures.run([sys.executable, reader, f"{self.instance}-{role}", *names],
                             "merlind", WAY_OUT)
        rows = dict(line.split(" ", 1) for line in output.splitlines())
        for name in names:
            if not rows.get(name, "").startswith("["):
                did_not_run(f"merlind's {role}", f"it has not published {name}", WAY_OUT)
        return {name: int(value.split("]")[0].strip("[")) for name, value in rows.items()}

    def deadlines(self):
        """The number of deadlines while the wall moved, and how many of them were missed."""
        values = self.fields("wall", "wall.deadlines", "wall.late")
        return [values[f"wall.{name}"] for name in ("deadlines", "late")]

    def status(self):
        return json.loads(figures.run([f"{self.options.bin}/merlin", "status", "--json",
                                       "--instance", self.instance], "merlin status", WAY_OUT))

    def connections(self):
        """The present number of connections of each server."""
        return [server["connections"] for server in self.status()["servers"].values()]

    def cores(self):
        """The processor seconds that all threads have used so far."""
        with open(f"/proc/{self.process.pid}/stat", encoding="utf8") as file:
            words = file.read().rsplit(")", 1)[1].split()
        return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


class Children:
    """Starts processes; they are killed at the block's end."""

    def __init__(self):
        self.all = []

    def start(self, command):
        self.all.append(subprocess.Popen(command, stdout=subprocess.DEVNULL,
                                         stderr=subprocess.DEVNULL))
        return self.all[-1]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for child in self.all:
            child.terminate()
        for child in self.all:
            child.wait()


def wait_for(path):
    deadline = time.monotonic() + 10
    while not os.path.exists(path):
        if time.monotonic() > deadline:
            did_not_run(path, "it was not made within 10 s", WAY_OUT)
        time.sleep(0.02)
