#!/usr/bin/env python3
"""./dev bench page: the wall's late frames while nobody looks at the operator's page, while a headless Chromium has
it open for --open seconds, and after it was closed again (both of these for --seconds); and the resources of the
page's process.

The devices are emulated, and the ball turns the model all the time, so that every frame has a deadline.
Chromium draws the page on the processors on which the wall draws its frames; in a lab it runs elsewhere, so the
effect is worse here than with an operator's phone. To tell the two apart, a reader that fetches what the page
fetches, five times a second, and draws nothing is measured too.
"""
import argparse
import os
import re
import shutil
import sys
import threading
import time
import urllib.request

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))

import browser
import figures
import roles

MOST_MORE_PERCENT = 1.0  # late frames that the page may cost, in % of the frames that are due
WAY_OUT = "./dev setup installs chromium and chromedriver"
ASKED = ("/api/status", "/api/frames?since=0", "/picture.jpg")


class Wall:
    """A wall: its counts of frames, and the memory of the page's process."""

    def __init__(self, options):
        self.place = roles.Place(options, "page")
        self.place.make_model()
        self.port = roles.free_port()
        self.place.configure({"page": {"port": self.port}, "wall": {"rate": {"rate_hz": options.rate}}})
        self.emulators = [roles.Emulator(self.place, name, "turning", options.seed + i)
                          for i, name in enumerate(roles.DRIVERS)]
        self.programs = {role: self.place.role(role) for role in ("devices", "wall", "page")}
        self.segment = roles.Segment(self.place, "wall")

    def start(self):
        for program in (*self.emulators, *self.programs.values()):
            program.start()
        for program in self.programs.values():
            program.wait_ready()
        time.sleep(3)  # by now the governor knows the machine

    def counts(self):
        if not self.segment.reopen():
            figures.did_not_run("merlind --role wall", "its shared memory is gone", roles.WAY_OUT)
        return self.segment.value("wall.deadlines"), self.segment.value("wall.late")

    def page_mib(self):
        with open(f"/proc/{self.programs['page'].pid}/status", encoding="utf8") as file:
            return int(re.search(r"VmRSS:\s+(\d+)", file.read())[1]) / 1024

    def stop(self):
        for program in (*self.programs.values(), *self.emulators):
            program.stop()
        self.place.close()


def late_share(wall, seconds, meanwhile=lambda: None):
    """Late frames in % of those that are due, over `seconds`; `meanwhile` is called every second."""
    before, end = wall.counts(), time.monotonic() + seconds
    while time.monotonic() < end:
        meanwhile()
        time.sleep(min(1.0, max(0.0, end - time.monotonic())))
    due, late = (now - then for now, then in zip(wall.counts(), before))
    return figures.share_of(100 * late, due, "frames that were due")


class Chromium:
    """The page in a browser. Its chart and its picture have to change, which shows that it works."""

    def __init__(self, port):
        self.driver = browser.Driver(1280, 900)
        self.driver.open(f"http://127.0.0.1:{port}/")
        self.driver.until("the state is shown", lambda: self.driver.run(
            "return document.getElementById('head-rate').textContent !== '–'"))
        self.seen = set()

    def look(self):
        self.seen.add(self.driver.run("return document.getElementById('picture').src"))

    def close(self):
        self.driver.close()


class Reader:
    """Fetches what the page shows, until it is stopped."""

    def __init__(self, port):
        self.port, self.answers, self.ended = port, 0, threading.Event()
        self.thread = threading.Thread(target=self.read)
        self.thread.start()

    def read(self):
        while not self.ended.wait(0.2):
            for path in ASKED:
                try:
                    with urllib.request.urlopen(f"http://127.0.0.1:{self.port}{path}", timeout=10) as answer:
                        self.answers += bool(answer.read())
                except OSError:
                    pass  # counts as no answer

    def close(self):
        self.ended.set()
        self.thread.join()


def measure(options, report):
    if not shutil.which("chromedriver"):
        figures.did_not_run("chromedriver", "it is not installed", WAY_OUT)
    wall = Wall(options)
    try:
        wall.start()
        shares = {}
        figures.note(f"nobody looks, {options.seconds:g} s")
        shares["nobody"] = late_share(wall, options.seconds)
        memory = [wall.page_mib()]
        figures.note(f"a reader without a browser, {options.seconds:g} s")
        reader = Reader(wall.port)
        try:
            shares["reader"] = late_share(wall, options.seconds)
        finally:
            reader.close()
        if reader.answers < options.seconds:
            figures.did_not_run("the page", f"it gave {reader.answers} answers", roles.WAY_OUT)
        figures.note(f"the page is open in Chromium, {options.open:g} s")
        page = Chromium(wall.port)
        try:
            memory.append(wall.page_mib())
            shares["chromium"] = late_share(wall, options.open, page.look)
            memory.append(wall.page_mib())
        finally:
            page.close()
        if len(page.seen) < 2:
            figures.did_not_run("the page", "its picture did not change", roles.WAY_OUT)
        figures.note(f"nobody looks again, {options.seconds:g} s")
        shares["after"] = late_share(wall, options.seconds)
    finally:
        wall.stop()
    words = {"nobody": "nobody looks", "reader": "a reader fetches what the page fetches",
             "chromium": "open in Chromium, on the wall's own processors", "after": "closed again"}
    report.text(f"late frames of a wall of {options.rate:g} Hz whose model turns all the time, {options.seconds:g} s each, "
                f"{options.open:g} s in Chromium:")
    for name, share in shares.items():
        report.text(f"  {words[name]:48} {share:6.2f} %  of {share.count} due")
        report.figure(f"late_{name}", share, "%")
    report.text(f"memory of the page's process: {memory[0]:.1f} MiB, {memory[1]:.1f} with the page open, "
                f"{memory[2]:.1f} after {options.open:g} s; pictures that Chromium was seen to show: {len(page.seen)}")
    report.figure("page_memory_after", figures.Measured(memory[2], 1, "memory"), "MiB")
    kept = shares["reader"] - shares["nobody"] <= MOST_MORE_PERCENT
    report.text(f"limit: the page costs the wall at most {MOST_MORE_PERCENT:g} % of its frames; "
                + ("kept" if kept else "not kept"))
    return kept


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", required=True, help="folder of merlin and merlind")
    parser.add_argument("--seconds", type=float, default=60, help="length of each part without the browser")
    parser.add_argument("--open", type=float, default=600, help="seconds for which Chromium has the page open")
    parser.add_argument("--rate", type=float, default=30, help="frame rate of the wall in Hz")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json", action="store_true", help="the figures as one JSON object")
    options = parser.parse_args()
    figures.run_bench("page", options.json, lambda report: measure(options, report))


if __name__ == "__main__":
    main()
