"""That ./dev bench kill takes nothing of the killed process for the new one's, and judges what systemd adds."""
import time
import types
import unittest

import figures
import kill_bench


class Killed:
    """A wall that finishes a frame while it is being killed, and its successor, whose first one is there at the third look."""

    def __init__(self):
        self.finished, self.process, self.starts, self.looks = [time.monotonic_ns()], self, 0, 0

    def send_signal(self, _):
        self.finished.append(time.monotonic_ns())

    def wait(self):
        pass

    def start(self):
        self.starts += 1

    def reopen(self):
        return True

    def values(self, _):
        self.looks += 1
        if self.looks == 3:
            self.finished.append(time.monotonic_ns())
        return self.finished


class Kill(unittest.TestCase):
    def test_a_frame_of_the_killed_wall_is_not_the_new_picture(self):
        wall, bench = Killed(), kill_bench.Bench.__new__(kill_bench.Bench)
        bench.programs, bench.segments = {"wall": wall}, {"framebuffer": wall}
        began = time.monotonic_ns()
        took = bench.kill("wall", "framebuffer", bench.new_picture, types.SimpleNamespace(look=lambda: None))
        self.assertEqual((wall.starts, len(wall.finished)), (1, 3))
        self.assertGreaterEqual(took, (wall.finished[2] - wall.finished[1]) / 1e9)
        self.assertLessEqual(took, (wall.finished[2] - began) / 1e9)


class Judgement(unittest.TestCase):
    def setUp(self):
        self.report = figures.Report("kill")

    def test_the_units_wait_counts(self):
        self.assertEqual([kill_bench.unit_wait_s(role) for role in ("wall", "devices")], [0.1, 0.1])
        self.assertTrue(kill_bench.row(self.report, "kill -9 wall to picture", [1.95], 2))
        self.assertFalse(kill_bench.waits(self.report, "wall", [0.5, 1.95], 2))
        self.assertTrue(kill_bench.waits(self.report, "devices", [0.5, 0.89], 1))
        self.assertIn("1 of 2 beyond 2000", self.report.lines[1])

    def test_one_of_all_beyond_its_bound_is_too_many(self):
        self.assertFalse(kill_bench.row(self.report, "start to READY wall", [0.5] * 99 + [1.01], 1))
        self.assertEqual(self.report.figures["start_to_READY_wall.99"]["value"], 500)
        self.assertEqual(self.report.figures["start_to_READY_wall.maximum"]["value"], 1010)

    def test_bounds_are_those_that_were_promised(self):
        self.assertEqual((kill_bench.PICTURE_S, kill_bench.DATA_S, kill_bench.READY_S), (2, 1, 1))

    def test_a_tracker_that_sends_nothing_has_no_figure(self):
        segment = types.SimpleNamespace(reopen=lambda: True, value=lambda _: 0)
        came, missing = kill_bench.Records(segment).came()
        with self.assertRaises(figures.DidNotRun):
            figures.Measured(missing, came, "records of the tracker")


if __name__ == "__main__":
    unittest.main()
