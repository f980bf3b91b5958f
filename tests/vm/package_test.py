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

# Gives the tests the shell of vm.Vm once everything that starts with the machine has started.
SHELL_UNIT = """[Unit]
Description=Shell of the tests
After=multi-user.target
[Service]
ExecStart=/bin/sh -c 'exec 3<>/dev/virtio-ports/merlin.shell; echo "init: ready" >/dev/ttyS0; exec /bin/sh <&3 >&3 2>&3'
[Install]
WantedBy=graphical.target multi-user.target
"""


# The units' watchdogs allow 5 s, which is too little for an emulated machine.
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
        MACHINE = vm.Vm(f"{OPTIONS.work}/package-machine", f"{MODE[0]}x{MODE[1]}", root=root)
    except vm.Missing as missing:
        print(f"test-vm-package: skipped: {missing}")
        raise unittest.SkipTest(str(missing)) from missing
    shutil.copy(package, f"{MACHINE.shared}/merlin.deb")


def tearDownModule():
    if MACHINE:
        MACHINE.close()


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


def frames():
    """The wall's number of frames. Waits for it, since on a busy machine the status may lack it for a moment."""
    return vm.until(lambda: status().get("frames"), "the wall's status")


def lit(picture):
    """Share of the picture that is not dark: all channels of the background are below 32."""
    data = picture[2]
    every = 3 * 16  # one pixel in 16 is enough
    pixels = zip(data[0::every], data[1::every], data[2::every])
    return sum(1 for pixel in pixels if max(pixel) > 48) * every / len(data)


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
        MACHINE.run("systemctl set-property --runtime merlin-wall MemoryMax=infinity")
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
