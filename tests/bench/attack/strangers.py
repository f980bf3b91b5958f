"""Attacks on merlind's sockets by strangers who may connect, but have no permissions. Each attack is limited in
number and time; it takes a Target and returns in words what it did."""
import json
import os
import random
import socket
import struct
import time

GREETING = b"\xff" + bytes(8) + b"\x7f\3\0" + b"NULL".ljust(20, b"\0") + bytes(32)
CURVE_GREETING = b"\xff" + bytes(8) + b"\x7f\3\0" + b"CURVE".ljust(20, b"\0") + bytes(32)
VRPN_COOKIE = b"vrpn: ver. 07.38  0".ljust(24, b"\0")


def ready(kind):
    properties = b"\x0bSocket-Type" + struct.pack(">I", len(kind)) + kind
    body = b"\5READY" + properties + b"\x08Identity" + bytes(4)
    return b"\4" + bytes([len(body)]) + body


def connect(address):
    """A stream to ("127.0.0.1", PORT) or to a path; None if the connection is refused."""
    s = socket.socket(socket.AF_UNIX if isinstance(address, str) else socket.AF_INET)
    s.settimeout(2)
    try:
        s.connect(address)
        return s
    except OSError:
        s.close()
        return None


def send(s, data):
    """Sends data; returns the number of bytes sent before the other side closed or stopped reading."""
    sent = 0
    try:
        while s and sent < len(data):
            sent += s.send(data[sent:])
    except OSError:
        pass
    return sent


def push(s, data, seconds):
    """Sends the same data repeatedly."""
    end, sent = time.monotonic() + seconds, 0
    while time.monotonic() < end:
        n = send(s, data)
        sent += n
        if n < len(data):
            break
    return sent


def close(sockets):
    for s in sockets:
        if s:
            s.close()


class Target:
    """The addresses of a merlind's servers."""

    def __init__(self, folder, instance, vrpn, samples, spnav):
        self.commands = os.path.join(folder, f"{instance}-wall.command")
        self.topics = os.path.join(folder, f"{instance}-devices.status")
        self.vrpn, self.samples, self.spnav = ("127.0.0.1", vrpn), ("127.0.0.1", samples), spnav
        self.random = random.Random(1998)


def requests_of_two_parts(target):
    for _ in range(20):
        s = connect(target.commands)
        send(s, GREETING + ready(b"REQ") + b"\1\0\1\1a\0\1b")
        close([s])
    return "20 requests of two parts"


def random_bytes(target):
    for address in (target.commands, target.topics, target.samples, target.vrpn, target.spnav):
        for _ in range(100):
            s = connect(address)
            send(s, target.random.randbytes(300))
            close([s])
    return "500 connections with 300 random bytes"


def huge_frames(target):
    sent, all_ = 0, []
    for address, greeting in ((target.samples, CURVE_GREETING), (target.commands, GREETING)):
        for _ in range(4):
            s = connect(address)
            send(s, greeting + b"\6" + struct.pack(">Q", 1 << 31))
            sent += push(s, bytes(1 << 20), 1)
            all_.append(s)
    close(all_)
    return f"8 frames declared as 2 GiB, of which {sent / 1e6:.1f} MB went"


def silent_connections(target):
    held = [connect(address) for address, count in
            ((target.samples, 500), (target.vrpn, 200), (target.commands, 300),
             (target.topics, 300), (target.spnav, 200)) for _ in range(count)]
    time.sleep(1)
    close(held)
    return f"{len(held)} connections that say nothing"


def greeted_connections(target):
    held = [connect(target.commands) for _ in range(200)]
    for s in held:
        send(s, GREETING + ready(b"REQ"))
    time.sleep(1)
    close(held)
    return "200 clients of the commands that ask nothing"


def subscriptions(target):
    s = connect(target.topics)
    send(s, GREETING + ready(b"SUB"))
    end, sent = time.monotonic() + 2, 0
    while time.monotonic() < end:
        n = send(s, b"\0\xc8\1" + target.random.randbytes(199))
        sent += n
        if n < 202:
            break
    close([s])
    return f"{sent / 1e3:.0f} kB of subscriptions"


def requests(target):
    """A client that behaves well except for its speed, and reads none of the answers."""
    s = connect(target.commands)
    send(s, GREETING + ready(b"REQ"))
    body = json.dumps({"command": "status"}).encode()
    sent = push(s, (b"\1\0\0" + bytes([len(body)]) + body) * 100, 2)
    close([s])
    return f"{sent / 1e3:.0f} kB of requests"


def vrpn_messages(target):
    s = connect(target.vrpn)
    send(s, VRPN_COOKIE)
    sent = push(s, struct.pack(">IIIiiI", 24, 0, 0, 0, 999, 0) * 1000, 2)
    close([s])
    return f"{sent / 1e3:.0f} kB of empty VRPN messages"


def vrpn_lengths(target):
    for length in (0, 1, 23, 24, 0x7fffffff, 0x80000000, 0xffffffff):
        s = connect(target.vrpn)
        send(s, VRPN_COOKIE + struct.pack(">IIIiiI", length, 0, 0, 0, 1, 0) + bytes(64))
        close([s])
    return "7 VRPN messages of impossible lengths"


def datagrams(target):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        for i in range(200):
            s.sendto(f"127.0.0.1 {1024 + i}".encode() + b"\0", target.vrpn)
            s.sendto(target.random.randbytes(200), target.vrpn)
    return "400 datagrams to VRPN"


def space_mouse_messages(target):
    s = connect(target.spnav)
    sent = push(s, target.random.randbytes(65536), 2)
    close([s])
    return f"{sent / 1e3:.0f} kB of space mouse requests"


ALL = [requests_of_two_parts, random_bytes, huge_frames, silent_connections, greeted_connections,
       subscriptions, requests, vrpn_messages, vrpn_lengths, datagrams, space_mouse_messages]
