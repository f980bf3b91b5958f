#!/usr/bin/env python3
"""The attacker and the bare sink. Lines: flooder.py send|sink tcp:PORT|pty:LINK [BYTES|RATE].
Sockets: flooder.py knock|answer PORT|PATH [BYTES].

send: a line on which BYTES (newlines, noise) come as fast as somebody reads them; one reader at a time.
sink: opens such a line as merlind does, reads RATE bytes a second in steps of 10 ms, and discards them.
It blocks the sender as merlind does, and does no other work.
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


def address_of(where):
    return ("127.0.0.1", int(where)) if where.isdigit() else where


def knock(where, data):
    """Connects, sends until the server closes the connection, and connects again at once."""
    address = address_of(where)
    family = socket.AF_UNIX if isinstance(address, str) else socket.AF_INET
    while True:
        with socket.socket(family) as s:
            try:
                s.connect(address)
                while True:
                    s.sendall(data[:1024])
            except OSError:
                pass


def answer(where):
    """Accepts a client, reads its first bytes, closes the connection, and does no other work."""
    address = address_of(where)
    family = socket.AF_UNIX if isinstance(address, str) else socket.AF_INET
    if isinstance(address, str) and os.path.exists(address):
        os.unlink(address)
    with socket.create_server(address, family=family) as listener:
        while True:
            client, _ = listener.accept()
            with client:
                client.recv(1024)


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
    role, target, what = (sys.argv + [""])[1:4]
    if role == "knock":
        knock(target, payload(what))
    elif role == "answer":
        answer(target)
    elif role == "sink":
        sink(target, float(what))
    elif target.startswith("tcp:"):
        send_tcp(int(target[4:]), payload(what))
    else:
        send_pty(target[4:], payload(what))
