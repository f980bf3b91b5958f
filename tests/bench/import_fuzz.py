#!/usr/bin/env python3
"""Gives damaged models and FITS files to the isolated merlin-import, and counts the outcomes.

The files are synthetic (tests/support/textured_models.py, and those written here). Each input is one of them
with one to four changes: bytes are changed, pieces cut out or doubled, numbers made large. The same seed gives
the same files. Every run must end by itself with a result, or with one line that gives the reason why there is
none. A library that crashes is counted, and must leave no file outside of its folder.
"""
import argparse
import base64
import collections
import concurrent.futures
import gzip
import json
import os
import pathlib
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time

import figures

HERE = pathlib.Path(__file__).resolve().parent
BATCH = 100  # files, between two looks at the clock
KINDS = ("made", "refused", "contained", "FAULT")  # with one of these words each outcome begins
WAY_OUT = "'./dev bench fuzz-imports' builds merlin-import and merlin"
NUMBERS = [b"-1", b"0", b"1e38", b"-1e30", b"nan", b"inf", b"4294967295", b"99999999999", b"0.5"]


def fits_of_two():
    def unit(first, name, width):
        cards = [first, "BITPIX  = %20d" % -32, "NAXIS   = %20d" % 2, "NAXIS1  = %20d" % width, "NAXIS2  = %20d" % 4,
                 "EXTNAME = '%s'" % name, "GEOMETRY= 'pinhole '", "ANGLEH  = 40.0", "ANGLEV  = 30.0", "END"]
        head = b"".join(b"%-80s" % c.encode() for c in cards)
        pixels = struct.pack(">%df" % (4 * width), *(2 + 0.1 * i for i in range(4 * width)))
        return head.ljust(2880) + pixels.ljust(2880, b"\0")
    return unit("SIMPLE  =                    T", "ONE", 4) + unit("XTENSION= 'IMAGE   '", "TWO", 6)


def glb_of(gltf):
    scene = json.loads(gltf)
    data = base64.b64decode(scene["buffers"][0].pop("uri").split(",")[1])
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I", len(text)) + b"JSON" + text + struct.pack("<I", len(data)) + b"BIN\0" + data
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


def originals(folder):
    """(kind, format, name, bytes)"""
    read = lambda name: (folder / name).read_bytes()
    iv = (b"#Inventor V2.1 ascii\nTexture2 { filename \"tile.png\" wrapS CLAMP } Cube { }\n"
          b"Texture2 { image 2 2 3 0xff0000 0xff00 0xff 0xffffff } Cone { }\nTranslation { translation 3 0 0 } Sphere { }\n")
    return [("model", "wrl", "a.wrl", read("room.wrl")), ("model", "gltf", "a.gltf", read("room.gltf")),
            ("model", "glb", "a.glb", glb_of(read("room.gltf"))), ("model", "iv", "a.iv", iv),
            ("model", "iv", "a.iv.gz", gzip.compress(iv, mtime=0)), ("model", "obj", "a.obj", read("room.obj")),
            ("grid", None, "a.fits", fits_of_two())]


def changed(data, rng):
    data = bytearray(data)
    for _ in range(rng.choice([1, 1, 2, 4])):
        if not data:
            break
        at, way = rng.randrange(len(data)), rng.choice([0, 1, 2, 3, 4, 4, 4, 4, 5])
        if way == 0:
            data[at] = rng.randrange(256)
        elif way == 1:
            data[at] ^= 1 << rng.randrange(8)
        elif way == 2:
            del data[at:at + rng.choice([1, 1, 4, 60])]
        elif way == 3:
            data[at:at] = data[at:at + rng.choice([1, 4, 64, 300])]
        elif way == 4:
            numbers = list(re.finditer(rb"-?\d+(\.\d+)?", bytes(data)))
            if numbers:
                n = rng.choice(numbers)
                data[n.start():n.end()] = rng.choice(NUMBERS)
        elif rng.random() < 0.2:
            del data[at:]
    return bytes(data)


def outcome_of(program, kind, form, path, folder):
    command = [program, kind, str(path), str(folder), "--memory", str(2 << 30), "--cpu", "20"]
    command += ["--format", form] if form else ["--hdu", "TWO"]
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=60, check=False)
    except subprocess.TimeoutExpired:
        return "FAULT: not ended after 60 s", ""
    lines = done.stdout.decode(errors="replace").splitlines()
    last = lines[-1] if lines else ""
    joined = any(line.startswith("note ") and " became one of " in line for line in lines)
    if done.returncode < 0:
        return f"contained: signal {-done.returncode}", ""
    if done.returncode == 0 and last.startswith("done "):
        return "made, one texture of several" if joined else "made", last.split()[1]
    if last.startswith("failed "):
        return "refused", ""
    return f"FAULT: status {done.returncode} without a reason", ""


def one(options, pictures, number):
    rng = random.Random(options.seed * 1_000_003 + number)
    kind, form, name, data = rng.choice(options.originals)
    with tempfile.TemporaryDirectory(dir=options.work) as text:
        place = pathlib.Path(text)
        (place / "work").mkdir()
        for picture in pictures:
            shutil.copy(picture, place)
        if number < len(options.originals):  # undamaged, to see that the program reads it
            kind, form, name, data = options.originals[number]
        (place / name).write_bytes(data if number < len(options.originals) else changed(data, rng))
        before = sorted(p.name for p in place.iterdir())
        outcome, made = outcome_of(options.program, kind, form, place / name, place / "work")
        if sorted(p.name for p in place.iterdir()) != before:
            outcome = "FAULT: a file was written outside of its folder"
        if number < len(options.originals) and not made:
            outcome = f"FAULT: {outcome}, though it is not damaged"
        if made and kind == "model":
            info = subprocess.run([options.merlin, "mesh", "info", str(place / "work" / made), "--json"],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=60, check=False)
            if info.returncode not in (0, 2):
                outcome = f"FAULT: merlin mesh info of what was made ended with {info.returncode}"
        return name, outcome


def outcomes_of(options):
    """How many files of each ending had each outcome, and a sentence for each fault."""
    counts, faults = collections.Counter(), []
    with tempfile.TemporaryDirectory() as work:
        options.work = work
        models = pathlib.Path(work) / "models"
        models.mkdir()
        figures.run([sys.executable, "-B", HERE.parent / "support/textured_models.py", models], "textured_models.py",
                    "it makes the undamaged models; run it by hand")
        options.originals = originals(models)
        pictures = sorted(models.glob("*.png"))
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            numbers, began = range(options.first, options.first + options.count), time.monotonic()
            for at in range(0, len(numbers), BATCH):
                if time.monotonic() - began > options.seconds:
                    break
                some = numbers[at:at + BATCH]
                for number, (name, outcome) in zip(some, pool.map(lambda n: one(options, pictures, n), some)):
                    counts[name.split(".", 1)[1], outcome] += 1
                    if outcome.startswith("FAULT"):
                        faults.append(f"{name}: {outcome}; again: --count 1 --first {number} --seed {options.seed}")
    return counts, faults


def measure(options, report):
    options.program, options.merlin = options.bin + "/merlin-import", options.bin + "/merlin"
    for program in (options.program, options.merlin):
        if not os.access(program, os.X_OK):
            figures.did_not_run(program, "there is no such program", WAY_OUT)
    counts, faults = outcomes_of(options)
    total = sum(counts.values())
    made = sum(n for (_, outcome), n in counts.items() if outcome.startswith("made"))
    if total >= BATCH and made == 0:  # of a few files all may be refused
        figures.did_not_run("merlin-import", f"it made nothing of {total} files", WAY_OUT)
    for (ending, outcome), n in sorted(counts.items()):
        report.text(f"{ending:8} {outcome:32} {n:6}  {100 * n / total:.2f} %")
    for kind in KINDS:
        n = sum(n for (_, outcome), n in counts.items() if outcome.startswith(kind))
        report.figure(kind.lower(), figures.share_of(n, total, "files"), "1")
    report.text(f"{total} files, {made} made, {len(faults)} faults")
    for fault in faults:
        report.text(fault)
    report.more["faults"] = faults
    return not faults


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=5000, help="number of files")
    parser.add_argument("--seed", type=int, default=1, help="seed of the changes")
    parser.add_argument("--first", type=int, default=0, help="number of the first file")
    parser.add_argument("--seconds", type=float, default=600, help="no further file is begun after this time")
    parser.add_argument("--bin", required=True, help="folder of merlin-import and merlin")
    parser.add_argument("--json", action="store_true", help="the figures as one JSON object")
    options = parser.parse_args()
    figures.run_bench("fuzz-imports", options.json, lambda report: measure(options, report))


if __name__ == "__main__":
    main()
