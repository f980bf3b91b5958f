#!/usr/bin/env python3
"""The Debian packages on a fresh Debian 12 with its own systemd, in a virtual machine: ./dev test-vm-package

debootstrap makes the Debian once, with the libraries that the packages depend on; each run begins with a
copy. The tests judge states and pictures; the times that they print are those of an emulated machine.
"""
import argparse
import glob
import json
import os
import shutil
import subprocess
import time
import unittest

import vm

OPTIONS = None
MACHINE = None
MODE = (1024, 768)
UNITS = ("merlin-devices", "merlin-wall", "merlin-page")
EMULATOR = None  # of the ball on a serial adapter, which each test may plug in; its other end is on the host
BALL = {"driver": "usb-serial", "id": "ball", "chardev": "ball-line"}

# Gives the tests the shell of vm.Vm once everything that starts with the machine has started.
SHELL_UNIT = """[Unit]
Description=Shell of the tests
After=multi-user.target
[Service]
ExecStart=/bin/sh -c 'exec 3<>/dev/virtio-ports/merlin.shell; echo "init: ready" >/dev/ttyS0; exec /bin/sh <&3 >&3 2>&3'
[Install]
WantedBy=graphical.target multi-user.target
"""


# Shell commands that succeed where a drop-in allows what it is for, as the unit's user. A device is a file that the test
# makes: one that is let through says that there is no such device, if there is none behind it.
DEVICE = """said=$( (exec 3<>{0}) 2>&1 ) && exit 0
case "$said" in *"No such device"*) exit 0;; esac
exit 1"""
# A connection to itself, in the network of the machine.
NETWORK = """test "$(readlink /proc/self/ns/net)" = "$(cat /mnt/network)" || exit 1
exec perl -MSocket -e 'socket(S, PF_INET, SOCK_STREAM, 0) && bind(S, sockaddr_in(0, INADDR_LOOPBACK)) && listen(S, 1)
  && socket(C, PF_INET, SOCK_STREAM, 0) && connect(C, getsockname(S)) or exit 1'"""
FILES = "touch /srv/merlin/probe"
WINDOW = "test \"$DISPLAY\" = :0 && test -e /tmp/.X11-unix/X0"
MAIL = "/usr/local/bin/probe-touch /var/mail/probe"  # setuid
DROP_INS = (
    ("merlin-devices", "network.conf", NETWORK),
    ("merlin-devices", "gpio.conf", DEVICE.format("/dev/probe-gpio")),
    ("merlin-devices", "input.conf", DEVICE.format("/dev/probe-input")),
    ("merlin-devices", "files.conf", FILES),
    ("merlin-wall", "network.conf", NETWORK),
    ("merlin-wall", "gpu.conf", DEVICE.format("/dev/probe-gpu")),
    ("merlin-wall", "displays.conf", DEVICE.format("/dev/probe-display")),
    ("merlin-wall", "window.conf", WINDOW),
    ("merlin-wall", "files.conf", FILES),
    ("merlin-alarms", "mail.conf", MAIL),
)
# What the probes look for, and how it is taken away again. Numbers of devices: input 13, graphics cards 226.
PROBED = """mkdir -p /srv/merlin /tmp/.X11-unix && chown merlin:merlin /srv/merlin && touch /tmp/.X11-unix/X0
readlink /proc/self/ns/net >/mnt/network
install -m 4755 /usr/bin/touch /usr/local/bin/probe-touch
gpio=$(sed -n 's/^ *\\([0-9]*\\) gpiochip$/\\1/p' /proc/devices)
mknod -m 660 /dev/probe-gpio c $gpio 0 && chgrp gpio /dev/probe-gpio
mknod -m 660 /dev/probe-input c 13 95 && chgrp input /dev/probe-input
mknod -m 660 /dev/probe-gpu c 226 191 && chgrp render /dev/probe-gpu
mknod -m 660 /dev/probe-display c 226 63 && chgrp video /dev/probe-display"""
NOT_PROBED = """systemctl reset-failed 'probe*'; rm -rf /srv/merlin /tmp/.X11-unix /usr/local/bin/probe-touch /var/mail/probe /dev/probe-* /run/systemd/system/probe*
systemctl daemon-reload"""


# An emulated machine takes seconds for what the watchdogs of the units allow 5 s for.
SLOW = "[Service]\nWatchdogSec=120\n"


def dependencies(package):
    """Names of the packages that it depends on; of alternatives, the first one."""
    field = subprocess.run(["dpkg-deb", "--field", package, "Depends"], check=True, capture_output=True, text=True)
    return [entry.split("|")[0].split("(")[0].strip() for entry in field.stdout.split(",")]


def make_debian(folder, package):
    """Makes a Debian 12 with systemd and everything that `package` depends on."""
    if os.path.exists(f"{folder}/made"):
        return
    if shutil.which("debootstrap") is None or os.geteuid() != 0:
        raise vm.Missing("debootstrap is not there, or this is not root")
    shutil.rmtree(folder, ignore_errors=True)
    try:
        debootstrap(folder, package)
    except subprocess.CalledProcessError as failed:
        raise vm.Missing(f"the Debian was not made: {failed}") from failed
    open(f"{folder}/made", "w", encoding="utf-8").close()


def debootstrap(folder, package):
    subprocess.run(["debootstrap", "--variant=minbase", "--include=systemd,systemd-sysv,udev,dbus,procps", "bookworm",
                    f"{folder}/root"], check=True, stdout=subprocess.DEVNULL)
    for name in glob.glob("/etc/apt/apt.conf.d/*"):  # perhaps there is a proxy
        shutil.copy(name, f"{folder}/root/etc/apt/apt.conf.d/")
    with open(f"{folder}/root/usr/sbin/policy-rc.d", "w", encoding="utf-8") as file:
        file.write("#!/bin/sh\nexit 101\n")  # no package may start a service here
    os.chmod(f"{folder}/root/usr/sbin/policy-rc.d", 0o755)
    subprocess.run(["chroot", f"{folder}/root", "env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "install", "-qy",
                    "--no-install-recommends", *dependencies(package)], check=True, stdout=subprocess.DEVNULL)
    os.unlink(f"{folder}/root/usr/sbin/policy-rc.d")


def start_emulator(package):
    """Starts the package's own emulator of a ball on the host. Arguments of QEMU for its line; none where it does not run."""
    global EMULATOR
    unpacked, link = f"{OPTIONS.work}/package-unpacked", f"{OPTIONS.work}/package-ball"
    shutil.rmtree(unpacked, ignore_errors=True)
    subprocess.run(["dpkg-deb", "-x", package, unpacked], check=True)
    command = [f"{unpacked}/usr/bin/merlin", "emulate", "spaceball", "--link", link, "--script", "turning"]
    emulator = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    if not emulator.stdout.readline():  # else it is there
        emulator.wait()
        emulator.stdout.close()
        return []
    EMULATOR = emulator
    return ["-chardev", f"serial,id=ball-line,path={link}", "-device", "qemu-xhci,id=usb"]


def setUpModule():
    global MACHINE
    package = glob.glob(f"{OPTIONS.packages}/merlin_*.deb")[0]
    root = f"{OPTIONS.work}/package-root"
    try:
        make_debian(f"{OPTIONS.work}/debian", package)
        shutil.rmtree(root, ignore_errors=True)
        subprocess.run(["cp", "-a", "--reflink=auto", f"{OPTIONS.work}/debian/root", root], check=True)
        units = f"{root}/etc/systemd/system"
        with open(f"{units}/vm-shell.service", "w", encoding="utf-8") as file:
            file.write(SHELL_UNIT)
        os.makedirs(f"{units}/multi-user.target.wants", exist_ok=True)
        os.symlink("../vm-shell.service", f"{units}/multi-user.target.wants/vm-shell.service")
        for unit in UNITS:
            os.makedirs(f"{units}/{unit}.service.d")
            with open(f"{units}/{unit}.service.d/slow.conf", "w", encoding="utf-8") as file:
                file.write(SLOW)
        MACHINE = vm.Vm(f"{OPTIONS.work}/package-machine", f"{MODE[0]}x{MODE[1]}", root=root, extra=start_emulator(package),
                        modules=("xhci-pci", "ftdi_sio"))
    except vm.Missing as missing:
        tearDownModule()
        print(f"test-vm-package: skipped: {missing}")
        raise unittest.SkipTest(str(missing)) from missing
    except BaseException:
        tearDownModule()  # unittest does not call it then
        raise
    shutil.copy(package, f"{MACHINE.shared}/merlin.deb")


def tearDownModule():
    if MACHINE:
        MACHINE.close()
    if EMULATOR:
        EMULATOR.kill()
        EMULATOR.wait()
        EMULATOR.stdout.close()


def state(unit):
    """The unit's state as systemd names it: "active", "inactive" ..."""
    return MACHINE.run(f"systemctl is-active {unit}", succeeds=False).strip()


def since(event, unit="merlin-wall"):
    """The time [s] at which the unit last entered a state: "ActiveEnter" (READY) or "InactiveEnter"."""
    return int(MACHINE.run(f"systemctl show -p {event}TimestampMonotonic --value {unit}")) / 1e6


def pid(unit):
    return int(MACHINE.run(f"systemctl show -p MainPID --value {unit}"))


def runs_again(unit, before):
    """Whether a process other than `before` is ready. One command asks for both, since they may change in between."""
    shown = dict(line.split("=") for line in MACHINE.run(f"systemctl show -p MainPID,ActiveState {unit}").split())
    return shown["ActiveState"] == "active" and int(shown["MainPID"]) not in (0, before)


def kill(process):
    """Kills the process; returns the time [s]."""
    return float(MACHINE.run(f"cut -d ' ' -f 1 /proc/uptime; kill -KILL {process}"))


def frame_buffers():
    """Number of pictures that the kernel holds for the card's displays, including those of its console."""
    return MACHINE.run("cat /sys/kernel/debug/dri/0/framebuffer").count("framebuffer[")


def spread(name, seconds):
    """The distribution of the values, as a line of text."""
    ordered = sorted(seconds)
    at = lambda share: ordered[min(len(ordered) - 1, int(share * len(ordered)))]
    print(f"{name}, {len(ordered)} times: least {ordered[0]:.2f} s, median {at(0.5):.2f} s, 95 % {at(0.95):.2f} s, "
          f"most {ordered[-1]:.2f} s")


def shown_until(condition):
    """Takes screendumps until the condition is true. Returns the least share of a display that was lit, and
    their number."""
    least, count, until = 1.0, 0, time.monotonic() + vm.DEADLINE_S
    while True:
        for head in range(vm.HEADS):
            least = min(least, lit(MACHINE.screendump(head)))
        count += 1
        if condition():
            return least, count
        if time.monotonic() > until:
            raise AssertionError(f"not within {vm.DEADLINE_S} s; the least lit display showed {least:.3f}")


def status():
    return json.loads(MACHINE.run("merlin status --json"))


def ball():
    """What `merlin status` says of it."""
    return status().get("devices", {}).get("ball", {})


def frames():
    """The wall's number of frames. Waits for it, since on a busy machine the status may lack it for a moment."""
    return vm.until(lambda: status().get("frames"), "the wall's status")


def lit(picture):
    """Share of the picture that is not dark: all channels of the background are below 32."""
    data = picture[2]
    every = 3 * 16  # one pixel in 16 is enough
    pixels = zip(data[0::every], data[1::every], data[2::every])
    return sum(1 for pixel in pixels if max(pixel) > 48) * every / len(data)


def drop_in_file(unit, name):
    """Where it is installed: that of the installed configuration's displays is in effect."""
    folder = "/usr/lib/systemd/system" if name == "displays.conf" else "/usr/share/merlin"
    return f"{folder}/{unit}.service.d/{name}"


def are_allowed(cases):
    """Of (unit, drop-in or None, command): whether the command succeeds as a service with all restrictions of the unit
    and of its drop-in."""
    own = "Restart|RestartSec|WatchdogSec|ExecReload|FileDescriptorStoreMax|PartOf|Wants|After|RuntimeDirectory|StateDirectory"
    script = ["set -e", "cd /run/systemd/system"]
    for i, (unit, drop_in, command) in enumerate(cases):
        with open(f"{MACHINE.shared}/probe{i}", "w", encoding="utf-8") as file:
            file.write(command + "\n")
        script.append(f"sed -E -e '/^({own})=/d' -e 's/^Type=.*/Type=oneshot/' -e 's|^ExecStart=.*|ExecStart=/bin/sh /mnt/probe{i}|' "
                      f"/usr/lib/systemd/system/{unit}.service >probe{i}.service")
        if drop_in:
            script.append(f"mkdir probe{i}.service.d && cp {drop_in_file(unit, drop_in)} probe{i}.service.d/")
    with open(f"{MACHINE.shared}/make-probes", "w", encoding="utf-8") as file:
        file.write("\n".join([*script, "systemctl daemon-reload", ""]))
    MACHINE.run("sh /mnt/make-probes")
    mark = "was allowed"
    return [mark in MACHINE.run(f"systemctl start probe{i} 2>/dev/null && echo {mark}", succeeds=False) for i in range(len(cases))]


class Package(unittest.TestCase):
    """The steps of an administrator, in this order; unittest sorts tests by name."""

    def test_1_installed_it_is_neither_enabled_nor_started(self):
        MACHINE.run("apt-get install -qy --no-install-recommends /mnt/merlin.deb")
        self.assertEqual(MACHINE.run("systemctl is-enabled merlin.target", succeeds=False).strip(), "disabled")
        for unit in ("merlin.target",) + UNITS:
            self.assertEqual(state(unit), "inactive", unit)
        self.assertIn("merlin", MACHINE.run("stat -c %U /var/lib/merlin"))

    def test_2_started_it_shows_the_model_on_every_display_without_an_alarm(self):
        begin = time.monotonic()
        MACHINE.run("systemctl start merlin.target merlin-devices merlin-wall || { journalctl -u 'merlin-*' --no-pager | tail -n 30; false; }")
        print(f"from systemctl start to READY {time.monotonic() - begin:.1f} s")
        self.assertEqual([state(u) for u in ("merlin.target",) + UNITS], ["active"] * 4)
        self.assertEqual(MACHINE.run("systemctl show -p Slice --value merlin-wall").strip(), "merlin.slice")
        tasks = f"/proc/{pid('merlin-wall')}/task/*"
        nice = MACHINE.run(f"for t in {tasks}; do [ \"$(cat $t/comm)\" != wall ] || cut -d' ' -f19 $t/stat; done").strip()
        self.assertEqual(nice, "-10", "the wall's thread may not go first")
        print(MACHINE.run("merlin status"))
        until = time.monotonic() + 10 + vm.DEADLINE_S  # the playlist begins after ten seconds
        shown = []
        while time.monotonic() < until:  # the picture follows READY by a frame
            shown = [lit(MACHINE.screendump(head)) for head in range(vm.HEADS)]
            if min(shown) > 0.03 and status()["playlist"] == "running":
                break
        print("share of each display that is lit:", ", ".join(f"{share:.2f}" for share in shown))
        self.assertGreater(min(shown), 0.03)
        self.assertEqual(status()["playlist"], "running")
        self.assertEqual(MACHINE.run("journalctl -u merlin-devices -u merlin-wall -p warning -o cat --no-pager"), "")
        before = MACHINE.screendump(0)
        while MACHINE.screendump(0) == before and time.monotonic() < until:
            pass
        self.assertNotEqual(MACHINE.screendump(0), before, "the model does not turn")

    def test_3_killed_at_any_time_the_wall_is_back_and_no_display_was_dark(self):
        MACHINE.run("mountpoint -q /sys/kernel/debug || mount -t debugfs debugfs /sys/kernel/debug")
        until_back, pictures, held = [], 0, 0
        for i in range(OPTIONS.kills):
            before, devices = pid("merlin-wall"), pid("merlin-devices")
            killed = kill(before)
            least, count = shown_until(lambda: runs_again("merlin-wall", before))
            self.assertGreater(least, 0.03, "a display was dark")
            pictures += count
            until_back.append(since("ActiveEnter") - killed)
            self.assertEqual(pid("merlin-devices"), devices, "the devices' process was restarted as well")
            vm.until(lambda: frames() > 2, "frames after the restart")
            vm.until(lambda: frame_buffers() <= 3 * vm.HEADS + 1, "the killed process's pictures are freed")
            held = max(held, frame_buffers())
        spread("the wall's process killed, to READY", until_back)
        print(f"{pictures} times four screendumps meanwhile, none dark; {held} frame buffers in the kernel afterwards")
        least, _ = self.restarted("merlin-wall")
        self.assertGreater(least, 0.03, "a display was dark during systemctl restart")

    def restarted(self, unit):
        before = pid(unit)
        MACHINE.run(f"systemctl restart --no-block {unit}")
        return shown_until(lambda: runs_again(unit, before))

    def test_4_killed_the_devices_process_is_back_and_the_wall_does_not_notice(self):
        wall, until_back = pid("merlin-wall"), []
        for _ in range(OPTIONS.kills):
            before, drawn = pid("merlin-devices"), frames()
            killed = kill(before)
            least, _ = shown_until(lambda: runs_again("merlin-devices", before))
            self.assertGreater(least, 0.03)
            until_back.append(since("ActiveEnter", "merlin-devices") - killed)
            vm.until(lambda: frames() > drawn, "the wall goes on")
        spread("the devices' process killed, to READY", until_back)
        self.assertEqual(pid("merlin-wall"), wall)

    def test_4b_out_of_memory_it_is_back_and_a_clock_that_is_set_back_is_nothing(self):
        before = pid("merlin-wall")
        MACHINE.run("systemctl set-property --runtime merlin-wall MemoryMax=32M")
        least, _ = shown_until(lambda: pid("merlin-wall") != before)
        MACHINE.run("rm /run/systemd/system.control/merlin-wall.service.d/50-MemoryMax.conf; systemctl daemon-reload")
        also, _ = shown_until(lambda: runs_again("merlin-wall", before))
        self.assertGreater(min(least, also), 0.03)
        self.assertIn("oom-kill", MACHINE.run("journalctl -u merlin-wall -o cat --no-pager"))
        before, drawn = pid("merlin-wall"), frames()
        MACHINE.run("date --set '-1 hour'")
        vm.until(lambda: frames() > drawn + 3, "the wall goes on")
        MACHINE.run("date --set '+1 hour'")
        vm.until(lambda: frames() > drawn + 6, "the wall goes on")
        self.assertEqual([pid("merlin-wall"), state("merlin-devices")], [before, "active"])

    def test_4c_a_reload_that_needs_a_start_keeps_process_and_picture(self):
        starts = lambda: int(MACHINE.run("journalctl -u merlin-wall -o cat --no-pager | grep -c ready"))
        before, count, devices = pid("merlin-wall"), starts(), pid("merlin-devices")
        MACHINE.run("mkdir -p /etc/merlin/conf.d; echo '{\"wall\": {\"snapshots\": \"/var/lib/merlin\"}}' "
                    ">/etc/merlin/conf.d/90-test.json; systemctl reload merlin-devices merlin-wall || "
                    "{ journalctl -u 'merlin-*' --no-pager | tail -n 30; false; }")
        least, _ = shown_until(lambda: starts() > count)
        self.assertGreater(least, 0.03, "a display was dark")
        self.assertEqual([pid("merlin-wall"), pid("merlin-devices"), state("merlin-wall")], [before, devices, "active"])
        vm.until(lambda: frames() > 2, "frames after the start")
        MACHINE.run("rm /etc/merlin/conf.d/90-test.json; systemctl reload merlin-wall")
        vm.until(lambda: starts() > count + 1, "the wall starts again")

    def test_5_a_broken_configuration_starts_with_the_last_good_one(self):
        MACHINE.run("cp /etc/merlin/merlin.json /root/good.json; echo '{' >/etc/merlin/merlin.json")
        MACHINE.run("systemctl restart merlin-devices merlin-wall")
        self.assertEqual([state(u) for u in UNITS[:2]], ["active"] * 2)
        self.assertEqual(status()["services"]["configuration"]["health"], "failed")
        MACHINE.run("cp /root/good.json /etc/merlin/merlin.json; systemctl reload merlin-devices merlin-wall")
        vm.until(lambda: status()["services"]["configuration"]["health"] == "ok", "the file is in effect again")

    def test_5b_each_drop_in_allows_what_it_is_for_and_the_unit_alone_does_not(self):
        shipped = MACHINE.run("(cd /usr/share/merlin && ls -d *.service.d/*; cd /usr/lib/systemd/system && ls -d merlin-*.service.d/*)")
        self.assertEqual(sorted(shipped.split()), sorted(f"{unit}.service.d/{name}" for unit, name, _ in DROP_INS))
        self.addCleanup(MACHINE.run, NOT_PROBED)
        MACHINE.run(f"(set -e\n{PROBED}\n)")
        units = sorted({unit for unit, _, _ in DROP_INS})
        found = are_allowed([(unit, None, "exit 0") for unit in units] + [(unit, None, probe) for unit, _, probe in DROP_INS]
                            + [(unit, name, probe) for unit, name, probe in DROP_INS])
        self.assertEqual(found[:len(units)], [True] * len(units), "units under which no probe runs")
        alone, with_it = found[len(units):len(units) + len(DROP_INS)], found[len(units) + len(DROP_INS):]
        names = [f"{unit}/{name}" for unit, name, _ in DROP_INS]
        self.assertEqual([name for name, allowed in zip(names, alone) if allowed], [], "allowed without the drop-in")
        self.assertEqual([name for name, allowed in zip(names, with_it) if not allowed], [],
                         MACHINE.run("journalctl -u 'probe*' -n 40 --no-pager"))

    def test_5c_a_serial_adapter_that_is_plugged_in_late_is_read_under_the_unit(self):
        if EMULATOR is None:
            self.skipTest("the package's merlin does not run on this host")
        config = json.dumps({"devices": [{"name": "ball", "driver": "spaceball", "port": "serial:/dev/ttyUSB0"}]})
        MACHINE.run(f"mkdir -p /etc/merlin/conf.d; echo '{config}' >/etc/merlin/conf.d/91-late.json; systemctl restart merlin-devices")
        vm.until(lambda: ball().get("health") == "absent", "the ball is not there yet")
        MACHINE.ask("device_add", **BALL)
        vm.until(lambda: ball().get("health") == "ok", "the ball streams")
        MACHINE.ask("device_del", id="ball")
        vm.until(lambda: ball().get("health") == "absent", "the ball is gone")
        MACHINE.run("rm /etc/merlin/conf.d/91-late.json; systemctl restart merlin-devices")

    def test_6_stopped_the_displays_are_the_consoles_again(self):
        MACHINE.run("systemctl stop merlin.target")
        vm.until(lambda: max(lit(MACHINE.screendump(head)) for head in range(vm.HEADS)) < 0.03, "dark displays")
        self.assertLessEqual(frame_buffers(), 1)
        MACHINE.run("systemctl start merlin.target merlin-wall")

    def test_7_an_upgrade_restarts_the_wall_and_keeps_the_configuration(self):
        before = pid("merlin-wall")
        MACHINE.run("sed -i 's/\"rate_hz\": 30/\"rate_hz\": 12/' /etc/merlin/merlin.json; echo x >/var/lib/merlin/mine")
        begin = time.monotonic()
        MACHINE.run("dpkg -i --force-confold /mnt/merlin.deb")
        print(f"upgrade of a running wall {time.monotonic() - begin:.1f} s, of which it was down "
              f"{since('ActiveEnter') - since('InactiveEnter'):.1f} s")
        self.assertNotIn(pid("merlin-wall"), (0, before))
        self.assertEqual(state("merlin-wall"), "active")
        self.assertEqual(status()["rate_asked"], 12)
        MACHINE.run("test -e /var/lib/merlin/mine")

    def test_8_removal_stops_it_and_keeps_configuration_and_state(self):
        MACHINE.run("dpkg --remove merlin")
        self.assertIn(state("merlin-wall"), ("inactive", "unknown"))
        MACHINE.run("test -e /var/lib/merlin/mine && grep -q 12 /etc/merlin/merlin.json && test ! -e /usr/bin/merlind")

    def test_9_purge_leaves_no_file(self):
        MACHINE.run("dpkg --purge merlin")
        left = MACHINE.run("find / -xdev -name '*merlin*' ! -path '/proc/*' ! -path '/mnt/*'; ls -d /run/merlin* /dev/shm/merlin*",
                           succeeds=False)
        self.assertEqual([line for line in left.splitlines() if line.startswith("/")], [])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--packages", required=True, help="folder of the packages")
    parser.add_argument("--work", required=True, help="folder for the machine's files")
    parser.add_argument("--kills", type=int, default=3, help="of each of the two processes (3)")
    OPTIONS, rest = parser.parse_known_args()
    OPTIONS.work = os.path.abspath(OPTIONS.work)
    unittest.main(argv=["package_test.py", *rest], failfast=True)
