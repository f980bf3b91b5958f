#!/usr/bin/env python3
"""Whether the wall notices what its displays really show, in a virtual machine: ./dev test-vm

spoil_display changes the picture of a display while the wall stays DRM master and nothing moves. The wall
has to find the fault, report it, restore its picture, and report that, too.
"""
import subprocess
import sys
import time
import unittest

import vm
import wall_test as wall
from vm import until

SPOILED, CONNECTOR = "centre", "Virtual-2"
# 5 s between two checks, half a second to a second reading, half a second until events are reported.
# The rest is tolerance for an emulated machine.
LONGEST_S = 12
STANDS_S = 3  # time without a new frame


def merlin(*arguments):
    subprocess.run([f"{wall.OPTIONS.bin}/merlin", *arguments], check=True, stdout=subprocess.DEVNULL)


def setUpModule():
    wall.setUpModule()
    wall.write_config("wall", small_wall())
    wall.start_wall()


def small_wall():
    """Starts a wall with a model that an emulated machine soon shows in full detail; then no more frames are
    drawn."""
    small = f"{wall.OPTIONS.work}/small"
    merlin("mesh", "export", f"{wall.OPTIONS.work}/model.mrm", "--percent", "2", "-o", f"{small}.ply")
    merlin("mesh", "reduce", f"{small}.ply", "-o", f"{small}.mrm")
    config = wall.read_config("wall")
    config["wall"]["model"] = f"{small}.mrm"
    return config


def tearDownModule():
    wall.tearDownModule()


def frames():
    return [output["frames"] for output in wall.outputs().values()]


def stands_still():
    before, end = frames(), time.monotonic() + STANDS_S
    while time.monotonic() < end:
        if frames() != before:
            return False
    return True


def pictures():
    return {name: output["picture"] for name, output in wall.outputs().items()}


class Picture(unittest.TestCase):
    def setUp(self):
        until(lambda: set(pictures().values()) == {"right"}, "each output shows what was meant")
        until(wall.shows_signals, "each display shows the signal of its output")
        until(stands_still, "nothing is drawn any more")

    def spoil(self, how, name=SPOILED, connector=CONNECTOR):
        """Spoils a display; returns the time at which that was done."""
        wall.MACHINE.run(f"spoil_display {wall.CARD} {wall.PID} {connector} {how}")
        return time.monotonic()

    def is_found_and_mended(self, spoiled, what):
        said = wall.MACHINE.wait_for(rf"output {SPOILED} (is black|stands|shows).*")
        found_s = time.monotonic() - spoiled
        self.assertIn(what, said)
        self.assertIn(CONNECTOR, said)
        wall.MACHINE.wait_for(rf"output {SPOILED} shows what was meant again")
        print(f"found after {found_s:.1f} s, mended {time.monotonic() - spoiled - found_s:.1f} s later ", end="",
              file=sys.stderr)
        self.assertLess(found_s, LONGEST_S)
        until(wall.shows_signals, "the display shows its signal again")
        self.assertEqual(set(pictures().values()), {"right"})

    def test_1_the_check_costs_milliseconds(self):
        costs = {name: output["picture_ms"] for name, output in wall.outputs().items()}
        print(f"{costs} ", end="", file=sys.stderr)
        self.assertTrue(all(0 < cost < 1000 for cost in costs.values()))

    def test_2_a_display_that_is_switched_off_is_black(self):
        self.is_found_and_mended(self.spoil("off"), "is black instead of what was meant")

    def test_3_a_picture_that_is_overwritten_is_black(self):
        self.is_found_and_mended(self.spoil("black"), "is black instead of what was meant")

    def test_4_another_programs_buffer_is_not_the_walls(self):
        self.is_found_and_mended(self.spoil("foreign"), "shows a picture that is not the wall's")

    def test_5_an_older_frame_stands_still(self):
        self.spoil("keep /run/older")
        self.show_card("grid")
        self.is_found_and_mended(self.spoil("put /run/older"), "stands still on an older frame")
        self.show_card("off")

    def test_6_parts_of_two_frames_are_torn(self):
        self.spoil("keep /run/older")
        self.show_card("edges")
        self.is_found_and_mended(self.spoil("half /run/older"), "shows parts of two frames")
        self.show_card("off")

    def test_7_a_black_picture_that_is_meant_is_right(self):
        wall.MACHINE.run("merlin blank")
        until(lambda: wall.colours(wall.MACHINE.screendump(1)) == {b"\0\0\0"}, "the wall is black")
        end = time.monotonic() + LONGEST_S
        while time.monotonic() < end:
            self.assertEqual(set(pictures().values()), {"right"})
        wall.MACHINE.run("merlin blank")
        until(lambda: wall.colours(wall.MACHINE.screendump(1)) != {b"\0\0\0"}, "the picture is back")

    def test_8_a_program_that_takes_the_displays_is_the_outputs_fault(self):
        thief = int(wall.MACHINE.run(f"take_display {wall.CARD} {wall.PID} >/run/log 2>&1 & echo $!"))
        wall.MACHINE.wait_for_all(*(f"output {name} failed" for name in wall.NAMES))
        until(lambda: pictures()[SPOILED] == "unchecked", "what fails anyway is not checked")
        wall.MACHINE.run(f"kill {thief}; wait {thief}", succeeds=False)
        wall.MACHINE.wait_for_all(*(f"output {name} works again" for name in wall.NAMES))

    def show_card(self, name):
        before = wall.MACHINE.screendump(1)
        wall.MACHINE.run(f"merlin wall testcard {name}")
        until(lambda: wall.MACHINE.screendump(1) != before and wall.shows_signals(), f"test card {name}")


if __name__ == "__main__":
    wall.OPTIONS, argv = vm.arguments()
    unittest.main(argv=argv, failfast=True)
