#!/usr/bin/env python3
"""The wall on four displays, in a virtual machine: ./dev test-vm

The tests judge pictures, health and the order of events, but no rates and no latencies, since the machine is
emulated. Each test leaves the wall running with all four displays lit.
"""
import json
import os
import subprocess
import sys
import unittest

import vm
from vm import until  # used for pictures, which follow their events by a frame

sys.path.insert(0, os.path.join(vm.HERE, "..", "support"))
import check_wall_picture  # noqa: E402  its reader of PNG files

NAMES = ("left", "centre", "right", "operator")
MODE = (640, 480)
CARD = "/dev/dri/card0"
OPTIONS = None
MACHINE = None
PID = None  # merlind's process in the machine


def setUpModule(modules=()):
    """Starts the machine with further modules of its kernel, and writes the wall's configuration."""
    global MACHINE
    model = f"{OPTIONS.work}/model.mrm"
    os.makedirs(OPTIONS.work, exist_ok=True)
    subprocess.run([f"{OPTIONS.bin}/merlin", "mesh", "reduce",
                    f"{vm.HERE}/../../config/models/ankylosaurus.ply", "-o", model], check=True,
                   stdout=subprocess.DEVNULL)
    try:
        MACHINE = vm.Vm(f"{OPTIONS.work}/machine", f"{MODE[0]}x{MODE[1]}", modules=modules)
    except vm.Missing as missing:
        print(f"test-vm: skipped: {missing}")
        raise unittest.SkipTest(str(missing)) from missing
    with open(f"{vm.HERE}/wall.json", encoding="utf-8") as file:
        config = json.load(file)
    config["wall"]["model"] = model
    config["run_directory"] = "/run/merlin"
    config["state_file"] = "/run/merlin.state.json"
    write_config("wall", config)
    # Sets the path of the programs, and a folder for Mesa's cache. The log goes through a pipe, since merlind
    # leaves out lines for which a terminal has no room.
    MACHINE.run(f"PATH=$PATH:{OPTIONS.bin} HOME=/run; export PATH HOME\n"
                "mkfifo /run/log; exec 4<>/run/log; cat <&4 >/dev/ttyS0 &")


def tearDownModule():
    if MACHINE:
        MACHINE.close()


def write_config(name, config):
    with open(f"{MACHINE.shared}/{name}.json", "w", encoding="utf-8") as file:
        json.dump(config, file)


def read_config(name):
    with open(f"{MACHINE.shared}/{name}.json", encoding="utf-8") as file:
        return json.load(file)


def start_wall(config="wall"):
    """Starts merlind with its log on the console, and waits until it is ready."""
    global PID
    command = f"merlind --role wall --config /mnt/{config}.json >/run/log 2>&1 & echo $!"
    PID = int(MACHINE.run(command))
    MACHINE.wait_for(r"ready")


def stop_wall(signal):
    MACHINE.run(f"kill -{signal} {PID}; wait {PID}", succeeds=False)


def outputs():
    """The entry of each output in `merlin status`."""
    return json.loads(MACHINE.run("merlin status --json"))["outputs"]


def picture(name, command):
    """(width, height, RGB bytes) of the PNG file that a command in the machine writes."""
    MACHINE.run(f"{command} -o /mnt/{name}.png")
    width, height, step, rows = check_wall_picture.read_png(f"{MACHINE.shared}/{name}.png")
    pixels = b"".join(rows)
    if step == 4:
        rgb = bytearray(width * height * 3)
        for channel in range(3):
            rgb[channel::3] = pixels[channel::4]
        pixels = bytes(rgb)
    return width, height, pixels


def signal(name):
    return picture(f"signal-{name}", f"merlin snapshot --output {name}")


def part(image, x, y, width, height):
    """A rectangle of a picture."""
    rows = (image[2][((y + row) * image[0] + x) * 3:((y + row) * image[0] + x + width) * 3]
            for row in range(height))
    return width, height, b"".join(rows)


def turned(image):
    """The picture turned by 180 degrees."""
    return image[0], image[1], b"".join(image[2][i:i + 3] for i in range(len(image[2]) - 3, -1, -3))


def at_rest():
    """Whether the wall shows full detail, after which its pictures no longer change."""
    return json.loads(MACHINE.run("merlin status --json"))["full_detail"]


def shows_signals(names=NAMES):
    return all(MACHINE.screendump(NAMES.index(name)) == signal(name) for name in names)


def colours(image):
    return {image[2][i:i + 3] for i in range(0, len(image[2]), 3 * 7)}


def connector(number, state):
    MACHINE.run(f"echo {state} > /sys/class/drm/card0-Virtual-{number}/status")


class Wall(unittest.TestCase):
    def setUp(self):
        if PID is None:
            start_wall()
        until(at_rest, "the wall shows full detail")
        until(shows_signals, "each display shows the signal of its output")

    def test_1_four_displays_show_the_signals_of_four_outputs(self):
        for name in NAMES:
            self.assertEqual(outputs()[name]["health"], "ok", name)
        canvas = picture("canvas", "merlin snapshot")
        tiles = {"left": (0, 0), "centre": (640, 0), "right": (0, 480), "operator": (640, 480)}
        seen = {}
        for head, name in enumerate(NAMES):
            shown = MACHINE.screendump(head)
            self.assertEqual(shown[:2], MODE)
            self.assertTrue(shown == signal(name), f"{name}: the display differs from the output's signal")
            self.assertGreater(len(colours(shown)), 16, f"{name}: something is drawn")
            seen[name] = shown
        self.assertEqual(len({image[2] for image in seen.values()}), 4, "four different pictures")
        for name, (x, y) in tiles.items():
            tile = part(canvas, x, y, *MODE)
            if name == "right":
                tile = turned(tile)
            if name == "centre":  # this output has a correction
                self.assertFalse(seen[name] == tile, "the correction changed nothing")
            else:
                self.assertTrue(seen[name] == tile, f"{name}: the display differs from the canvas")

    def test_2_a_pulled_connector_leaves_the_others_and_comes_back(self):
        connector(2, "off")
        said = MACHINE.wait_for(r"output centre failed.*")
        self.assertIn(f"nothing is plugged in at Virtual-2 of {CARD}", said)
        health = {name: output["health"] for name, output in outputs().items()}
        self.assertEqual(health, {"shared_memory": "ok", "left": "ok", "centre": "failed", "right": "ok",
                                  "operator": "ok"})
        before = MACHINE.screendump(0)
        MACHINE.run("merlin wall testcard grid")  # a change that the other displays show
        until(lambda: MACHINE.screendump(0) != before and shows_signals(("left", "right", "operator")),
              "the other three show the test card")
        connector(2, "on")
        MACHINE.wait_for(r"output centre works again")
        until(shows_signals, "the display that was pulled shows its signal again")
        MACHINE.run("merlin wall testcard off")

    def test_3_all_connectors_pulled_and_back(self):
        for number in range(1, 5):
            connector(number, "off")
        MACHINE.wait_for_all(*(f"output {name} failed" for name in NAMES))
        for number in range(4, 0, -1):
            connector(number, "on")
        MACHINE.wait_for_all(*(f"output {name} works again" for name in NAMES))
        until(shows_signals, "all four are back")

    def test_4_another_program_takes_the_displays_and_gives_them_back(self):
        thief = int(MACHINE.run(f"take_display {CARD} {PID} >/run/log 2>&1 & echo $!"))
        for said in MACHINE.wait_for_all("take_display: has the displays",
                                         *(f"output {name} failed.*" for name in NAMES))[1:]:
            self.assertIn(f"another program has the displays of {CARD}: take_display ({thief})", said)
        for head in range(4):
            self.assertEqual(colours(MACHINE.screendump(head)), {b"\x80\x00\x80"}, head)
        self.assertEqual(outputs()["shared_memory"]["health"], "ok")
        MACHINE.run(f"kill {thief}; wait {thief}", succeeds=False)
        MACHINE.wait_for_all(*(f"output {name} works again" for name in NAMES))
        until(shows_signals, "the wall has its displays again")

    def test_5_the_wall_is_killed_and_started_again(self):
        stop_wall("KILL")
        start_wall()
        until(shows_signals, "the new wall shows its signals")

    def test_6_a_wall_that_ends_restores_what_was_there(self):
        stop_wall("TERM")
        text = [MACHINE.screendump(head) for head in range(4)]
        start_wall()
        until(shows_signals, "the wall shows its signals")
        stop_wall("TERM")
        self.assertTrue([MACHINE.screendump(head) for head in range(4)] == text, "the consoles changed")
        start_wall()

    def test_7_a_program_that_has_the_displays_first_is_waited_for(self):
        stop_wall("TERM")
        holder = int(MACHINE.run(f"take_display {CARD} >/run/log 2>&1 & echo $!"))
        MACHINE.wait_for("take_display: has the displays")
        start_wall()
        until(lambda: all(outputs()[name]["reason"].startswith("another program has the displays")
                          for name in NAMES), "four outputs say who has the displays")
        MACHINE.run(f"kill {holder}; wait {holder}", succeeds=False)
        MACHINE.wait_for_all(*(f"output {name} works again" for name in NAMES))

    def test_8_what_is_not_there_is_said_and_the_rest_stays_up(self):
        stop_wall("TERM")
        config = read_config("wall")
        kms = {output["name"]: output["kms"] for output in config["wall"]["outputs"] if "kms" in output}
        kms["left"]["connector"] = "HDMI-A-7"
        kms["right"]["mode"] = "641x481"
        write_config("faults", config)
        start_wall("faults")
        left = until(lambda: outputs()["left"]["reason"], "left says what is wrong")
        self.assertEqual(left, f"{CARD} has no connector HDMI-A-7; it has Virtual-1, Virtual-2, Virtual-3, "
                               "Virtual-4")
        right = until(lambda: outputs()["right"]["reason"], "right says what is wrong")
        self.assertIn("Virtual-3 has no mode 641x481; it has ", right)
        until(lambda: shows_signals(("centre", "operator")), "the other two are lit")
        stop_wall("TERM")
        kms["left"]["connector"], kms["right"]["mode"] = "Virtual-1", "640x480"
        for display in kms.values():
            display["card"] = "/dev/dri/card5"
        write_config("faults", config)
        start_wall("faults")
        missing = until(lambda: outputs()["left"]["reason"], "left says what is wrong")
        self.assertEqual(missing, f"there is no card /dev/dri/card5; this machine has {CARD}")
        self.assertEqual(outputs()["shared_memory"]["health"], "ok")
        stop_wall("TERM")
        start_wall()


if __name__ == "__main__":
    OPTIONS, argv = vm.arguments()
    unittest.main(argv=argv, failfast=True)
