"""Measurements of a soak's processes, and conclusions from them: slopes with their confidence, descriptors that
grow, late frames. Pure, except for Sample.of(). A process that was restarted has a new life, with a level of
its own."""
import math
import os
import re
import statistics

LEAST = 60  # a slope needs at least as many points
Z = 1.96  # for 95 % of a normal distribution, on both sides
# Lists that are bounded, such as the page's last 500 events, fill for hours and take less than this when
# full.
LISTS_MIB = 0.25


class Sample:
    """The resources that a process holds at one time. `life`: the role, and the number of its starts."""

    def __init__(self, life, at_s, age_s, memory_mib, descriptors, threads):
        self.life, self.at_s, self.age_s = life, at_s, age_s
        self.memory_mib, self.descriptors, self.threads = memory_mib, descriptors, threads

    @staticmethod
    def of(pid, life, at_s, age_s):
        """A sample of the process; None if it has just ended."""
        try:
            with open(f"/proc/{pid}/status", encoding="utf8") as file:
                text = file.read()
            rss = re.search(r"VmRSS:\s+(\d+)", text)
            threads = re.search(r"Threads:\s+(\d+)", text)
            descriptors = len(os.listdir(f"/proc/{pid}/fd"))
        except OSError:
            return None
        if not rss or not threads:  # a zombie
            return None
        return Sample(life, at_s, age_s, int(rss[1]) / 1024, descriptors, int(threads[1]))


def longest_life(samples, warm_up_s):
    """The samples of the life with the most samples, without its warm-up."""
    lives = {}
    for sample in samples:
        if sample.age_s >= warm_up_s:
            lives.setdefault(sample.life, []).append(sample)
    return max(lives.values(), key=len, default=[])


def slope(points):
    """The slope of [(x, y)] by least squares, and the half width of its 95 % interval. Memory grows in steps,
    so neighbouring residuals are correlated; the number of points that count as independent is reduced
    accordingly. None if there are too few points."""
    n = len(points)
    if n < LEAST:
        return None
    mx, my = sum(x for x, _ in points) / n, sum(y for _, y in points) / n
    sxx = sum((x - mx) ** 2 for x, _ in points)
    b = sum((x - mx) * (y - my) for x, y in points) / sxx
    residuals = [y - my - b * (x - mx) for x, y in points]
    square = sum(r * r for r in residuals)
    alike = sum(a * c for a, c in zip(residuals, residuals[1:])) / square if square > 0 else 0
    alike = min(max(alike, 0), 0.999)
    degrees = max(n * (1 - alike) / (1 + alike) - 2, 1)
    # Student's t, within 3 % from 3 degrees of freedom on
    t = Z * (1 + (Z * Z + 1) / (4 * degrees) + 2.5 / degrees ** 2)
    return b, t * math.sqrt(square / degrees / sxx)


def memory_slope(samples, warm_up_s):
    """(MiB/h, half width of the 95 % interval) of one role; None if that cannot be said."""
    return slope([(s.at_s / 3600, s.memory_mib) for s in longest_life(samples, warm_up_s)])


def grew(samples, warm_up_s):
    """MiB by which one role has certainly grown; 0 if that is within chance and bounded lists."""
    life, found = longest_life(samples, warm_up_s), memory_slope(samples, warm_up_s)
    if found is None:
        return 0
    least = (found[0] - found[1]) * (life[-1].at_s - life[0].at_s) / 3600
    return least if least > LISTS_MIB else 0


def descriptors(samples, warm_up_s):
    """(first, last) of one role: the medians of the first and of the last quarter of its longest life. Medians,
    since a device that is away has no descriptor for a moment. None if that life was too short."""
    warm = [s.descriptors for s in longest_life(samples, warm_up_s)]
    quarter = len(warm) // 4
    if quarter < 2:
        return None
    return statistics.median_low(warm[:quarter]), statistics.median_low(warm[-quarter:])


class Frames:
    """Counts deadlines while something moved, and missed ones, over all lives of the wall."""

    def __init__(self):
        self.generation, self.last, self.minutes = None, (0, 0), []

    def add(self, at_s, generation, deadlines, late):
        before = self.last if generation == self.generation else (0, 0)
        self.generation, self.last = generation, (deadlines, late)
        minute = int(at_s // 60)
        self.minutes += [[0, 0] for _ in range(minute + 1 - len(self.minutes))]
        self.minutes[minute][0] += deadlines - before[0]
        self.minutes[minute][1] += late - before[1]

    def first_and_rest(self):
        """[deadlines, late] of the first minute, and of all other minutes."""
        rest = [sum(m[i] for m in self.minutes[1:]) for i in (0, 1)]
        return (self.minutes or [[0, 0]])[0], rest
