"""A real merlind with a wall that moves, and the figures of it."""
import json
import os
import signal
import subprocess
import sys
import time


def make_model(options):
    """The demo's model, once a run."""
    if os.path.exists(options.model):
        return
    scan = os.path.join(options.source, "config/models/ankylosaurus.ply")
    subprocess.run([f"{options.bin}/merlin", "mesh", "reduce", scan, "-o", options.model],
                   check=True, capture_output=True)


class Wall:
    """merlind on a configuration of its own; `lines` maps glove, tracker and ball to ports, or is
    None: emulated devices, a ball that turns."""

    def __init__(self, options, lines, also=None):
        make_model(options)
        self.options, self.instance = options, f"merlin-attack-{os.getpid()}"
        with open(os.path.join(options.source, "config/demo.json"), encoding="utf8") as file:
            config = json.load(file)
        config.pop("$schema")
        config["instance"], config["run_directory"] = self.instance, options.folder
        config["wall"]["model"] = options.model
        if lines is None:
            config["devices"] = {"script": "turning"}
        else:
            config["devices"] = {name: {"port": port} for name, port in lines.items()}
        config.update(also or {})
        path = os.path.join(options.folder, "attack.json")
        with open(path, "w", encoding="utf8") as file:
            json.dump(config, file)
        self.log = open(os.path.join(options.folder, "merlind.log"), "w+", encoding="utf8")
        emulate = ["--emulate"] if lines is None else []
        self.process = subprocess.Popen([f"{options.bin}/merlind", "--config", path, *emulate],
                                        stdout=self.log, stderr=self.log)
        self.end = ""  # all that it said, once it has ended

    def __enter__(self):
        deadline = time.monotonic() + 60
        while "ready" not in self.said():
            assert self.process.poll() is None, f"merlind ended: {self.said()[-500:]}"
            assert time.monotonic() < deadline, f"merlind is not ready: {self.said()[-500:]}"
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
        """Whole numbers of the shared memory, one of each name."""
        reader = os.path.join(self.options.source, "daemon/shm/read_merlin.py")
        done = subprocess.run([sys.executable, reader, f"{self.instance}-{role}", *names],
                              capture_output=True, text=True, check=True)
        rows = (line.split(" ", 1) for line in done.stdout.splitlines())
        return {name: int(value.split("]")[0].strip("[")) for name, value in rows}

    def deadlines(self):
        """How many deadlines there were while it moved, and how many were missed."""
        values = self.fields("wall", "wall.deadlines", "wall.late")
        return [values[f"wall.{name}"] for name in ("deadlines", "late")]

    def status(self):
        done = subprocess.run([f"{self.options.bin}/merlin", "status", "--json", "--instance",
                               self.instance], capture_output=True, text=True, check=False)
        assert done.returncode == 0, f"merlin status: {done.stderr.strip()}"
        return json.loads(done.stdout)

    def connections(self):
        """Of each server, now."""
        return [server["connections"] for server in self.status()["servers"].values()]

    def cores(self):
        """Processor seconds of all of its threads so far."""
        with open(f"/proc/{self.process.pid}/stat", encoding="utf8") as file:
            words = file.read().rsplit(")", 1)[1].split()
        return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


class Children:
    """Processes that end with the block."""

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
        assert time.monotonic() < deadline, f"{path} was not made within 10 s"
        time.sleep(0.02)
