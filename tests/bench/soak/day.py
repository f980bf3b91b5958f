"""The scripted day of a soak: people who come and go, faults and reloads, in an order and at times that a seed
determines. Each act says which events it explains, and which of them have to come."""
import os
import random
import re
import signal
import subprocess
import time

import figures

EXPLAINS_S = 30  # the events of a fault come within this time


class Explanation:
    """Events of this kind and form belong to this act from now on until the time is over."""

    def __init__(self, act, kind, pattern, due):
        self.act, self.kind, self.due = act, kind, due
        self.pattern = re.compile(pattern)
        self.until, self.count = time.monotonic() + EXPLAINS_S, 0

    def takes(self, event):
        if event["kind"] != self.kind or not self.pattern.search(event["what"]):
            return False
        self.count += 1
        return True


class People:
    """One person at a time, with glove, tracker and ball: goes through the phases of the emulators' script
    `visit`. Between two visits nobody is there, for longer than the playlist waits."""
    PHASES, REST = 12, 1  # phases of the script; the phase in which nothing is touched

    def __init__(self, emulators, chance):
        self.emulators, self.chance = emulators, chance
        self.phase, self.next_at, self.visits, self.left = 0, time.monotonic(), 0, 0

    def tend(self, now):
        if now < self.next_at:
            return
        if self.left == 0 and self.phase == self.REST:  # a person comes
            self.visits += 1
            self.left = self.chance.randint(1, 3) * self.PHASES
        self.left = max(0, self.left - 1)
        self.step()
        goes = self.left == 0 and self.phase == self.REST
        self.next_at = now + (self.chance.uniform(12, 25) if goes else self.chance.uniform(0.4, 3))

    def step(self):
        self.phase = (self.phase + 1) % self.PHASES
        for emulator in self.emulators.values():
            if emulator.process.poll() is None:
                emulator.next()

    def back(self, name):
        """Brings a restarted emulator to the phase of the others."""
        for _ in range(self.phase):
            self.emulators[name].next()


class Day:
    """Performs one act after another. Thread-bound. tend() never waits long: what an act does later is kept in
    a list."""

    def __init__(self, wall, seed, every_s):
        self.wall, self.chance, self.every_s = wall, random.Random(seed), every_s
        self.people = People(wall.emulators, random.Random(seed + 1))
        self.explanations, self.later, self.done, self.deck = [], [], {}, []
        self.next_at = time.monotonic() + every_s
        self.kills = []  # (when, role), by kill_at()
        self.variant = 0
        self.disk = Disk(wall.disk, lambda: wall.programs["wall"].pid)

    def kill_at(self, times):
        """`times`: [(when, role)]. Roles are killed early in the day, so that each then lives long enough for
        its memory to be judged."""
        self.kills = sorted(times)

    def tend(self, now, may_begin):
        self.people.tend(now)
        for due in [item for item in self.later if item[0] <= now]:
            self.later.remove(due)
            due[1]()
        if self.later or not may_begin:
            return
        if self.kills and self.kills[0][0] <= now:
            self.begin(KILLS[self.kills.pop(0)[1]])
        elif self.next_at <= now:
            self.next_at = now + self.chance.uniform(0.7, 1.3) * self.every_s
            if not self.deck:
                self.deck = list(ACTS)
                self.chance.shuffle(self.deck)
            self.begin(self.deck.pop())

    def begin(self, act):
        figures.note(f"  {act.__name__.replace('_', ' ')}")
        self.done[act.__name__] = self.done.get(act.__name__, 0) + 1
        act(self)

    def after(self, seconds, function):
        self.later.append((time.monotonic() + seconds, function))
        self.later.sort(key=lambda item: item[0])

    def explains(self, act, kind, pattern, due=False):
        self.explanations.append(Explanation(act, kind, pattern, due))

    def explanation_of(self, event):
        """The act that explains this event, which has just come; None if there is none. If there are several,
        the last one is returned, and none of them has to wait for its event any more."""
        now = time.monotonic()
        found = [e.act for e in self.explanations if now <= e.until and e.takes(event)]
        return found[-1] if found else None

    def untold(self):
        """The acts whose events had to come and did not."""
        return [f"{e.act}: {e.kind}: {e.pattern.pattern}" for e in self.explanations
                if e.due and not e.count]

    def end(self):
        """Ends all acts that are still under way."""
        while self.later:
            self.later.pop(0)[1]()
        self.disk.free()

    def explain_devices(self, act, names, due=True):
        for name in names:
            self.explains(act, "device", f"^{name}: ok", due)
            self.explains(act, "device", f"^{name}: ")
            self.explains(act, "flight", name)


class Disk:
    """A folder of the wall whose disk can be full: a small file system of its own if we may mount one,
    otherwise a limit on the size of the files of the wall's process."""

    def __init__(self, folder, pid):
        self.folder, self.pid, self.ballast = folder, pid, os.path.join(folder, "ballast")
        os.makedirs(folder, exist_ok=True)
        self.mounted = subprocess.run(
            ["mount", "-t", "tmpfs", "-o", "size=32m,mode=0755", "merlin-soak", folder],
            capture_output=True, check=False).returncode == 0

    def fill(self):
        if not self.mounted:
            return self.limit("1")
        try:
            with open(self.ballast, "wb", buffering=0) as file:
                while True:
                    file.write(bytes(1 << 12))
        except OSError:
            pass

    def free(self):
        if not self.mounted:
            return self.limit("unlimited")
        if os.path.exists(self.ballast):
            os.unlink(self.ballast)

    def limit(self, size):
        figures.run(["prlimit", "--pid", self.pid(), f"--fsize={size}:unlimited"], "prlimit",
                    "it is part of util-linux")

    def close(self):
        if self.mounted:
            subprocess.run(["umount", "-l", self.folder], capture_output=True, check=False)


# The acts. Each begins when it is called and ends through day.after().

def emulator_is_killed(day):
    name = day.chance.choice(sorted(day.wall.emulators))
    emulator, act = day.wall.emulators[name], f"{name}'s emulator killed"
    day.explain_devices(act, [name])
    emulator.kill()
    day.after(day.chance.uniform(2, 6), lambda: (emulator.start(), day.people.back(name)))


def port_is_unlinked(day):
    """The line's name is removed while the line is open, then the device ends; then both return."""
    name = day.chance.choice(sorted(day.wall.emulators))
    emulator, act = day.wall.emulators[name], f"{name}'s port unlinked"
    day.explain_devices(act, [name])
    os.unlink(emulator.link)
    day.after(2, emulator.stop)
    day.after(day.chance.uniform(4, 8), lambda: (emulator.start(), day.people.back(name)))


def disk_is_full(day):
    """Takes a snapshot and changes the state while the disk is full, and again when it has room."""
    act = "disk full"
    day.explains(act, "service", "^state: failed", due=True)
    day.explains(act, "service", "^state: works again", due=True)
    day.explains(act, "service", "^snapshots: ")
    day.disk.fill()

    def change(rate):
        day.explains(act, "wall", "the desired frame rate is")
        day.wall.command("snapshot")
        day.wall.command("rate", rate)

    change(f"{0.9 * day.wall.rate:.3g}")
    day.after(4, day.disk.free)
    day.after(5, lambda: change("auto"))


def shared_memory_is_removed(day):
    role = day.chance.choice(["wall", "devices", "framebuffer"])
    act = f"shared memory of {role} removed"
    day.explains(act, "service", "^shared memory: failed", due=True)
    day.explains(act, "service", "^shared memory: works again", due=True)
    day.explains(act, "role", f"the role {role} ")  # to the page, the new segment is a restart
    if role == "devices":
        day.explain_devices(act, sorted(day.wall.emulators), due=False)
    os.unlink(f"/dev/shm/{day.wall.place.instance}-{role}")


def model_is_damaged(day):
    """Puts a file that is no model in the model's place, moved there as a copying program does; then the model
    again."""
    act, model = "model damaged", day.wall.place.model
    day.explains(act, "model", r"model\.mrm", due=True)
    with open(model, "rb") as file:
        whole = file.read()

    def put(data):
        with open(model + ".new", "wb") as file:
            file.write(data)
        os.rename(model + ".new", model)

    damaged = bytearray(whole)
    for at in range(len(damaged) // 3, len(damaged) // 3 + 4096):
        damaged[at] ^= 0xFF
    put(damaged)
    day.after(8, lambda: put(whole))


def wall_is_killed(day):
    role_is_killed(day, "wall")


def devices_are_killed(day):
    # Only a process that already follows the role again reports these events.
    day.explain_devices("role devices killed", sorted(day.wall.emulators), due=False)
    role_is_killed(day, "devices")


def role_is_killed(day, role):
    """Kills a role; the supervisor restarts it after the units' RestartSec, as systemd does."""
    act, program = f"role {role} killed", day.wall.programs[role]
    day.explains(act, "role", f"^the role {role} (runs|was started again)", due=True)
    day.explains(act, "role", f"^the role {role} does not run")
    program.process.send_signal(signal.SIGKILL)
    program.process.wait()
    day.after(0.1, lambda: day.wall.restart(role))


def good_reload(day):
    day.variant += 1
    variants = [{"postures": {"hold_s": 0.2}}, {"wall": {"scene": {"hand_gain": 2}}},
                {"hands": [{"cutoff_hz": 4}]}, {"bindings": [{"input": "posture.fist", "action": "fly"}]},
                {"wall": {"playlist": {"hold_s": 4}}}]
    reload(day, variants[day.variant % len(variants)], "good reload", 0)


def bad_reload(day):
    """Requests a bad reload by a command, for which both roles check the file first and only the sender is told."""
    day.variant += 1
    variants = [{"postures": {"hold_s": "long"}}, {"wall": {"no_such_key": 1}},
                {"bindings": [{"input": "posture.no-such", "action": "grab"}]},
                {"wall": {"render": {"wireframe": "yes"}}}]
    reload(day, variants[day.variant % len(variants)], "bad reload", 2)
    day.wall.place.write(day.wall.place.config)  # a role that is restarted needs a good configuration


def bad_reload_by_signal(day):
    """Requests a bad reload by a signal: each role refuses it with an event, which a good reload ends."""
    act = "bad reload by signal"
    day.explains(act, "service", "^configuration: failed", due=True)
    day.explains(act, "service", "^configuration: works again", due=True)
    day.wall.place.write(day.wall.place.config | {"no_such_key": 1})
    for role in ("devices", "wall"):
        day.wall.programs[role].process.send_signal(signal.SIGHUP)
    day.after(4, lambda: reload(day, {}, act, 0))


def reload(day, patch, act, status):
    done = day.wall.reload(patch)
    if done.returncode != status:
        day.wall.wrong.append(f"{act} {patch}: exit status {done.returncode}: {done.stdout[-200:]}"
                              f"{done.stderr[-200:]}")


def person_commands(day):
    """Sends the commands of a person at the page."""
    for command, argument in (("next_content", None), ("notice", "soak"), ("blank", None), ("blank", None),
                              ("reset_view", None), ("next_mode", None), ("next_mode", None),
                              ("snapshot", None)):
        day.wall.command(command, argument)


ACTS = [emulator_is_killed, port_is_unlinked, disk_is_full, shared_memory_is_removed, model_is_damaged,
        good_reload, good_reload, bad_reload, bad_reload_by_signal, person_commands]
KILLS = {"wall": wall_is_killed, "devices": devices_are_killed}
