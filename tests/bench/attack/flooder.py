#!/usr/bin/env python3
"""The attacker and the bare sink: flooder.py send|sink tcp:PORT|pty:LINK [BYTES|RATE]

send: a line on which BYTES (newlines, noise) comes as fast as somebody takes it; one at a time.
sink: opens such a line as merlind does and reads RATE bytes a second in steps of 10 ms, into
nothing: it blocks the sender as merlind does, and does no more.
"""
import os
import random
import socket
import sys
import termios
import time
import tty

STEP_S = 0.01


def payload(kind):
    if kind == "newlines":
        return b"\n" * 65536
    return random.Random(7).randbytes(65536)


def send_tcp(port, data):
    listener = socket.create_server(("127.0.0.1", port))
    while True:
        line, _ = listener.accept()
        try:
            while True:
                line.sendall(data)
        except OSError:
            line.close()


def send_pty(link, data):
    master, slave = os.openpty()
    tty.setraw(slave)
    if os.path.islink(link):
        os.unlink(link)
    os.symlink(os.ttyname(slave), link)
    while True:
        os.write(master, data)


def open_line(where):
    kind, at = where.split(":", 1)
    if kind == "pty":
        line = os.open(at, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(line, termios.TCSANOW)
        return lambda n: os.read(line, n)
    line = socket.socket()
    line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 65536)
    line.connect(("127.0.0.1", int(at)))
    return line.recv


def sink(where, rate):
    for _ in range(500):
        try:
            read = open_line(where)
            break
        except OSError:
            time.sleep(0.02)
    due = time.monotonic()
    while True:
        left = int(rate * STEP_S)
        while left > 0:
            left -= len(read(min(left, 65536))) or sys.exit("the line ended")
        due = max(due + STEP_S, time.monotonic() - STEP_S)
        time.sleep(max(0, due - time.monotonic()))


if __name__ == "__main__":
    role, target, what = sys.argv[1:4]
    if role == "sink":
        sink(target, float(what))
    elif target.startswith("tcp:"):
        send_tcp(int(target[4:]), payload(what))
    else:
        send_pty(target[4:], payload(what))
