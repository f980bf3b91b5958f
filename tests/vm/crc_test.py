#!/usr/bin/env python3
"""Compares what the kernel itself says a display shows with what the wall meant, in a virtual machine: ./dev test-vm

The display is the kernel's vkms, which has vertical blanks at 60 Hz and a CRC of each picture that it
scans out (debugfs). The test computes the same CRC of the picture from `merlin snapshot --output`, so it
judges the displays, and the wall's own check of them, independently of both.
"""
import re
import unittest
import zlib

import modules
import picture_test as picture
import vm
import wall_test as wall
from vm import until

NAME = "centre"
DEBUG = "/sys/kernel/debug/dri/1"
CONNECTOR = None
CARD = "/dev/dri/card1"
FRAMES = 10  # number of frames of a still picture whose CRCs are compared


def setUpModule():
    global CONNECTOR
    vkms = modules.build_or_skip(wall.OPTIONS.work, modules.VKMS, "the test of CRCs")
    wall.setUpModule((vkms,))
    wall.MACHINE.run("mount -t debugfs debugfs /sys/kernel/debug")
    CONNECTOR = wall.MACHINE.run("ls -d /sys/class/drm/card1-Virtual-*").strip().split("/card1-")[1]
    config = picture.small_wall()
    outputs = config["wall"]["outputs"]
    kept = next(output for output in outputs if output.get("name") == NAME)
    kept["kms"] |= {"card": CARD, "connector": CONNECTOR}
    config["wall"]["outputs"] = [outputs[0], kept]
    wall.write_config("wall", config)
    wall.start_wall()


def tearDownModule():
    wall.tearDownModule()


def crcs(count=1):
    """The CRCs of the next frames that the display scans out."""
    # Each read returns one frame: its number and its CRC.
    said = wall.MACHINE.run(f"dd if={DEBUG}/crtc-0/crc/data bs=64 count={count} status=none")
    return [int(crc, 16) for crc in re.findall(r"0x[0-9a-f]{8} (0x[0-9a-f]{8})", said)]


def crc_of(image):
    """The value that vkms computes of a picture: a CRC-32 with start value 0 of alpha, red, green and blue, 16
    bits each."""
    pixels = bytearray(b"\xff" * (image[0] * image[1] * 8))
    for channel in range(3):
        for byte in range(2):  # 8 bits times 257 are 16 bits
            pixels[2 + 2 * channel + byte::8] = image[2][channel::3]
    return zlib.crc32(pixels, 0xFFFFFFFF) ^ 0xFFFFFFFF


class Crc(unittest.TestCase):
    def setUp(self):
        until(lambda: picture.pictures()[NAME] == "right", "the output shows what was meant, by the wall's own check")
        until(picture.stands_still, "nothing is drawn any more")

    def shown(self):
        """Waits for a still picture, whose CRC has to be that of the output's signal; returns the CRC."""
        signal = crc_of(wall.signal(NAME))
        until(lambda: crcs() == [signal], f"the kernel's CRC is {signal:#x}, that of the output's signal")
        self.assertEqual(set(crcs(FRAMES)), {signal})
        return signal

    def test_1_a_still_picture_has_one_crc_and_another_picture_another(self):
        model = self.shown()
        wall.MACHINE.run("merlin wall testcard grid")
        until(lambda: crcs() != [model], "the picture changes")
        until(picture.stands_still, "the test card is there")
        self.assertNotEqual(self.shown(), model)
        wall.MACHINE.run("merlin wall testcard off")
        until(lambda: crcs() == [model], "the same picture has the same CRC")
        self.assertEqual(self.shown(), model)
        self.assertEqual(picture.pictures()[NAME], "right")

    def test_2_what_the_wall_finds_and_mends_the_kernel_sees(self):
        model = self.shown()
        for how, said in (("black", "is black instead of what was meant"),
                          ("foreign", "shows a picture that is not the wall's")):
            wall.MACHINE.run(f"spoil_display {CARD} {wall.PID} {CONNECTOR} {how}")
            self.assertNotEqual(crcs(), [model], how)
            self.assertIn(said, wall.MACHINE.wait_for(rf"output {NAME} (is black|stands|shows).*"))
            wall.MACHINE.wait_for(rf"output {NAME} shows what was meant again")
            until(lambda: crcs() == [model], f"{how}: the kernel sees the picture again")

    def test_3_a_blank_wall_is_black(self):
        black = crc_of((*wall.MODE, bytes(wall.MODE[0] * wall.MODE[1] * 3)))
        wall.MACHINE.run("merlin blank")
        until(lambda: crcs() == [black], "the display is black")
        wall.MACHINE.run("merlin blank")
        until(lambda: crcs() != [black], "the picture is back")


if __name__ == "__main__":
    wall.OPTIONS, argv = vm.arguments()
    unittest.main(argv=argv, failfast=True)
