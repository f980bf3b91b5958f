#!/usr/bin/env python3
"""A shader whose render target is the memory that a display shows, in a virtual machine: ./dev test-vm

draw_display takes the way of merlind's frames, with the code of merlind: a buffer of the display is
shared as a dma-buf, imported into EGL, drawn into by the shader of the corrections and committed. Mesa's
software renderer draws in place of a GPU.
"""
import re
import unittest

import vm

OPTIONS = None
MODE = (640, 480)
HEAD, CONNECTOR = 1, "Virtual-2"
FRAMES = 6
ROUNDING = 1  # of 255: the shader's difference from the CPU, which computes what has to be shown


def read_ppm(path):
    with open(path, "rb") as file:
        data = file.read()
    header = re.match(rb"P6\s(\d+) (\d+)\s255\s", data)
    return int(header[1]), int(header[2]), data[header.end():]


class ScanOut(unittest.TestCase):
    def setUp(self):
        try:
            self.machine = vm.Vm(f"{OPTIONS.work}/machine", f"{MODE[0]}x{MODE[1]}")
        except vm.Missing as missing:
            print(f"test-vm: the test of displays' memory is skipped: {missing}")
            raise unittest.SkipTest(str(missing)) from missing
        self.addCleanup(self.machine.close)

    def test_a_display_shows_what_a_shader_has_drawn_into_its_memory(self):
        machine, shown = self.machine, set()
        machine.run("mkfifo /run/next; { HOME=/run "
                    f"{OPTIONS.bin}/draw_display /dev/dri/card0 {CONNECTOR} /mnt </run/next >/dev/ttyS0 2>&1; "
                    "echo ended: $? >/dev/ttyS0; } & exec 5>/run/next")
        for number in range(FRAMES):
            said = machine.wait_for(rf"frame {number}: .*|draw_display: .*|ended: .*")
            found = re.match(rf"frame {number}: drawn, shown, read back as meant; "
                             r"(\d) buffers, (\d) imports\s*$", said)
            self.assertTrue(found, said)
            self.assertLessEqual(int(found[1]), 3, "buffers")
            self.assertEqual(found[1], found[2], "each buffer is imported once")
            is_there, meant = machine.screendump(HEAD), read_ppm(f"{machine.shared}/{number}.ppm")
            self.assertEqual(is_there[:2], meant[:2])
            furthest = max(abs(a - b) for a, b in zip(is_there[2], meant[2]))
            self.assertLessEqual(furthest, ROUNDING, f"frame {number}")
            shown.add(is_there[2])
            machine.run("echo >&5")
        self.assertEqual(len(shown), FRAMES, "each frame is another picture")
        machine.wait_for(r"ended: 0")


if __name__ == "__main__":
    OPTIONS, argv = vm.arguments()
    unittest.main(argv=argv, failfast=True)
