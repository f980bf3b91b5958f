#!/usr/bin/env python3
"""The wall's control panel on a GPIO chip of the kernel, in a virtual machine: ./dev test-vm

The chip is the kernel's simulator gpio-sim, so the way through libgpiod is tested: the tests read the lines
from the simulator, and press the button there. A tracker on a serial line has to go on all the time.
"""
import json
import unittest

import devices_test as devices
import modules
import vm
from vm import until

PROJECTOR, VIDEO, LAMP, BUTTON = range(4)
OFF, WARMING, ON, COOLING = range(4)
HEALTH = ("absent", "opening", "ok", "failed")
CONFIGURED = "/sys/kernel/config/gpio-sim/panel"
# A chip that is unplugged while its lines are held comes back with another number, but with the same label.
LABEL = "panel-of-a-test"
# For this time the panel refuses to switch the projectors on again, and executes the command afterwards.
COOL_DOWN_S = 5
CHIP = None


class Chip:
    """A chip with eight lines, which can be unplugged and plugged in again."""

    def __init__(self):
        devices.MACHINE.run("mount -t configfs configfs /sys/kernel/config\n"
                            f"mkdir -p {CONFIGURED}/bank && echo 8 >{CONFIGURED}/bank/num_lines\n"
                            f"echo {LABEL} >{CONFIGURED}/bank/label")
        self.plug()

    def plug(self):
        device, self.name = devices.MACHINE.run(f"echo 1 >{CONFIGURED}/live && cat {CONFIGURED}/dev_name "
                                                f"{CONFIGURED}/bank/chip_name").split()
        self.at = f"/sys/devices/platform/{device}/{self.name}"
        self.numbers = f"/sys/devices/platform/{device}/gpio/gpiochip*/base"

    def unplug(self):
        devices.MACHINE.run(f"echo 0 >{CONFIGURED}/live")

    def levels(self):
        """The levels of the lines for projectors, video switch and lamp."""
        return [int(level) for level in devices.MACHINE.run(
            "cat " + " ".join(f"{self.at}/sim_gpio{line}/value" for line in (PROJECTOR, VIDEO, LAMP))).split()]

    def press(self, pressed):
        devices.MACHINE.run(f"echo pull-{'up' if pressed else 'down'} >{self.at}/sim_gpio{BUTTON}/pull")

    def take(self, line):
        """Lets the kernel take a line, so that no one else can use it; returns a function that gives it back."""
        base = int(devices.MACHINE.run(f"cat {self.numbers}"))
        devices.MACHINE.run(f"echo {base + line} >/sys/class/gpio/export")
        return lambda: devices.MACHINE.run(f"echo {base + line} >/sys/class/gpio/unexport")


def setUpModule():
    global CHIP
    simulator = modules.build_or_skip(devices.OPTIONS.work, modules.GPIO_SIM, "the control panel")
    devices.setUpModule((simulator,))
    CHIP = Chip()


def tearDownModule():
    devices.tearDownModule()


def state(name):
    """Fields of the panel ("gpio") or of the tracker in shared memory; the keys lack that name."""
    fields = json.loads(devices.MACHINE.run("merlin shm dump --json"))["/merlin-devices"]
    return {field.removeprefix(f"{name}."): found.get("value") for field, found in fields.items()
            if field.startswith(f"{name}.")}


def panel():
    return state("gpio")


def health(name="gpio"):
    found = state(name)
    return HEALTH[found["health.state"]], found["health.reason"]


def merlin(command):
    devices.MACHINE.run(f"merlin {command}")


def refused(command):
    """The message of a command that is refused."""
    mark = "was executed"
    said = devices.MACHINE.run(f"merlin {command} && echo {mark}", succeeds=False)
    if mark in said:
        raise AssertionError(f"{command} was executed: {said}")
    return said


class Panel(unittest.TestCase):
    def start(self, **gpio):
        """Starts merlind with the panel and a tracker; it is stopped at the test's end."""
        lines = {"projector_line": PROJECTOR, "video_line": VIDEO, "lamp_line": LAMP, "button_line": BUTTON}
        times = {"warm_up_s": 1, "cool_down_s": COOL_DOWN_S, "interlock_s": 0}
        pid = devices.start(devices.entry("tracker", "serial:/dev/ttyS2"), state_file="/run/merlin.state.json",
                            gpio={"chip": LABEL} | lines | times | gpio,
                            bindings=[{"input": "panel.button", "action": "video_b"}])
        self.addCleanup(devices.stop, pid)
        until(lambda: health("tracker") == ("ok", ""), "the tracker streams")

    def levels_become(self, projector, video, lamp):
        until(lambda: CHIP.levels() == [projector, video, lamp],
              f"projectors, video switch and lamp are {projector}, {video}, {lamp}")

    def the_tracker_goes_on(self):
        before = state("tracker")
        self.assertEqual(HEALTH[before["health.state"]], "ok")
        until(lambda: state("tracker")["health.samples"] > before["health.samples"], "the tracker goes on")

    def test_1_commands_set_the_lines_and_the_button_runs_its_action(self):
        CHIP.press(False)
        self.start(chip=CHIP.name)
        until(lambda: health() == ("ok", ""), "the chip is open")
        self.assertEqual(CHIP.levels(), [0, 0, 0])
        merlin("projector_on")
        self.levels_become(1, 0, 0)
        until(lambda: panel()["power"] == ON, "the projectors have warmed up")
        merlin("projector_off")
        self.levels_become(0, 0, 0)
        self.assertRegex(refused("projector_on"),
                         "the projectors cool down: wait [1-5] s; it is switched on afterwards")
        self.assertEqual(CHIP.levels(), [0, 0, 0])
        self.levels_become(1, 0, 0)

        merlin("video_b")
        self.levels_become(1, 1, 0)
        merlin("video_a")
        self.levels_become(1, 0, 0)
        merlin("lamp_on")
        self.levels_become(1, 0, 1)
        merlin("lamp_fast")
        for lit in (0, 1, 0):
            self.levels_become(1, 0, lit)
        merlin("lamp_off")
        self.levels_become(1, 0, 0)

        for presses in (1, 2):
            CHIP.press(True)
            until(lambda: panel()["presses"] == presses, "the button is pressed")
            self.levels_become(1, 1, 0)
            CHIP.press(False)
            merlin("video_a")  # this takes longer than a button has to be released
            self.levels_become(1, 0, 0)
        self.the_tracker_goes_on()

    def test_2_a_chip_that_vanishes_and_returns(self):
        self.start()
        self.goes_and_comes()

    def test_3_the_same_without_a_button(self):
        self.start(button_line=-1)
        self.goes_and_comes()

    def goes_and_comes(self):
        merlin("projector_on")
        merlin("video_b")
        self.levels_become(1, 1, 0)
        CHIP.unplug()
        state, reason = until(lambda: health() if health()[0] != "ok" else None, "the panel's chip is seen to be gone")
        self.assertEqual(state, "absent")
        none = f"there is no GPIO chip {LABEL}; this machine has none"
        self.assertIn(reason, (none, f"{LABEL}: reading line {BUTTON}: No such device",
                               f"{LABEL}: line {PROJECTOR}: No such device"))
        self.assertIn(none, refused("lamp_on"))
        self.the_tracker_goes_on()
        CHIP.plug()
        until(lambda: health() == ("ok", ""), "the chip is back")
        self.levels_become(1, 1, 0)
        merlin("lamp_on")
        self.levels_become(1, 1, 1)

    def test_4_a_line_that_somebody_else_holds_is_waited_for(self):
        give_back = CHIP.take(LAMP)
        self.start()
        held = f"{LABEL}: another program or a driver holds line {LAMP}: sysfs"
        self.assertEqual(until(lambda: health(), "the panel has a state"), ("failed", held))
        self.assertIn(held, refused("projector_on"))
        self.the_tracker_goes_on()
        give_back()
        until(lambda: health() == ("ok", ""), "the line is free")
        self.levels_become(1, 0, 0)  # the refused command is executed afterwards

    def test_5_what_is_not_there_is_said(self):
        self.start(lamp_line=8)
        until(lambda: health() == ("failed", f"{LABEL} has no line 8; it has 8 lines, from 0 on"), "the line is missed")
        self.the_tracker_goes_on()
        self.doCleanups()
        self.start(chip="gpiochip99")
        missed = f"there is no GPIO chip gpiochip99; this machine has {CHIP.name} ({LABEL})"
        until(lambda: health() == ("absent", missed), "the chip is missed")
        self.the_tracker_goes_on()


if __name__ == "__main__":
    devices.OPTIONS, argv = vm.arguments()
    unittest.main(argv=argv, failfast=True)
