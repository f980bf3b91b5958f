"""That a soak finds what it is for: memory and descriptors that grow, and nothing where they do not; and that it says when nothing happened."""
import math
import random
import types
import unittest

import soak  # the first, since it says where the others are
import figures
from measures import Frames, Sample, descriptors, grew, memory_slope

HOUR = 3600


def series(memory, count=600, fds=lambda i: 20, life=("wall", 1)):
    return [Sample(life, i, i, memory(i), fds(i), 9) for i in range(count)]


def noise(seed):
    chance = random.Random(seed)
    return lambda: chance.gauss(0, 0.5)


class Memory(unittest.TestCase):
    def test_a_leak_is_beyond_chance_and_its_size_is_found(self):
        more = noise(1)
        slope, half = memory_slope(series(lambda i: 200 + 30 * i / HOUR + more()), 10)
        self.assertAlmostEqual(slope, 30, delta=3)
        self.assertGreater(slope - half, 0)

    def test_noise_is_within_chance_in_about_39_of_40_runs(self):
        beyond = 0
        for seed in range(200):
            more = noise(seed)
            slope, half = memory_slope(series(lambda i: 200 + more()), 10)
            beyond += slope - half > 0
        self.assertLessEqual(beyond, 12)

    def test_steps_up_and_down_are_within_chance_since_neighbours_are_alike(self):
        slope, half = memory_slope(series(lambda i: 200 + 20 * (i // 150 % 2)), 10)
        self.assertGreater(half, abs(slope))

    def test_what_a_list_takes_until_it_is_full_is_no_growth(self):
        self.assertEqual(grew(series(lambda i: 200 + 0.2 * i / 600), 10), 0)
        self.assertAlmostEqual(grew(series(lambda i: 200 + 0.4 * i / 600), 10), 0.39, delta=0.01)
        self.assertEqual(grew(series(lambda i: 200 - i), 10), 0)
        self.assertEqual(grew([], 10), 0)

    def test_the_warm_up_does_not_count(self):
        slope, half = memory_slope(series(lambda i: 200 - 50 * math.exp(-i / 5)), 100)
        self.assertLess(abs(slope), 0.01)

    def test_a_start_is_no_growth(self):
        short = series(lambda i: 100, 100)
        slope, _ = memory_slope(short + series(lambda i: 300, life=("wall", 2)), 10)
        self.assertEqual(slope, 0)

    def test_too_little_is_no_slope(self):
        self.assertIsNone(memory_slope(series(lambda i: 200, 69), 10))
        self.assertIsNotNone(memory_slope(series(lambda i: 200, 70), 10))
        self.assertIsNone(memory_slope([], 10))


class Descriptors(unittest.TestCase):
    def test_one_more_at_the_end_is_found(self):
        self.assertEqual(descriptors(series(lambda i: 1, fds=lambda i: 20 + (i > 300)), 10), (20, 21))

    def test_a_device_that_is_away_for_a_moment_is_none_less(self):
        self.assertEqual(descriptors(series(lambda i: 1, fds=lambda i: 18 if i % 60 < 10 else 20), 10), (20, 20))


class LateFrames(unittest.TestCase):
    def test_counts_go_on_where_the_wall_was_started_anew(self):
        frames = Frames()
        frames.add(1, 7, 100, 5)
        frames.add(59, 7, 1000, 6)
        frames.add(70, 8, 50, 2)
        frames.add(200, 8, 150, 3)
        self.assertEqual(frames.first_and_rest(), ([1000, 6], [150, 3]))


class ADay(unittest.TestCase):
    def test_without_people_or_faults_is_no_soak(self):
        people = types.SimpleNamespace(visits=1)
        soak.expect_lived(people, {"bad_reload": 1, "person_commands": 9})
        for visits, done in ((0, {"bad_reload": 1}), (1, {"person_commands": 9})):
            people.visits = visits
            with self.assertRaises(figures.DidNotRun):
                soak.expect_lived(people, done)


if __name__ == "__main__":
    unittest.main()
