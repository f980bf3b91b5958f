#!/usr/bin/env python3
"""Sends OSC datagrams as a tracker does, 50 times a second until it is killed; uses the standard library alone.

send_osc.py tuio PORT   two fingers that pinch, as frames of /tuio/2Dcur from the source "test@localhost"
send_osc.py osc PORT    poses at /tracker/1/pose in millimetres that move along x, as bundles
"""
import socket
import struct
import sys
import time


def text(value):
    data = value.encode()
    return data + b"\0" * (4 - len(data) % 4)


def message(address, *values):
    tags, data = ",", b""
    for value in values:
        if isinstance(value, str):
            tags, data = tags + "s", data + text(value)
        elif isinstance(value, float):
            tags, data = tags + "f", data + struct.pack(">f", value)
        else:
            tags, data = tags + "i", data + struct.pack(">i", value)
    return text(address) + text(tags) + data


def bundle(*elements):
    return text("#bundle") + struct.pack(">Q", 1) + b"".join(struct.pack(">i", len(e)) + e for e in elements)


def tuio(count):
    apart = 0.1 + 0.002 * (count % 100)
    cursors = [(21, 0.5 - apart, 0.25), (22, 0.5 + apart, 0.75)]
    sets = [message("/tuio/2Dcur", "set", number, x, y, 0.0, 0.0, 0.0) for number, x, y in cursors]
    return bundle(message("/tuio/2Dcur", "source", "test@localhost"),
                  message("/tuio/2Dcur", "alive", *[cursor[0] for cursor in cursors]),
                  *sets, message("/tuio/2Dcur", "fseq", count))


def osc(count):
    return bundle(message("/tracker/1/pose", float(count % 1000), 500.0, -250.0, 0.0, 0.6, 0.0, 0.8))


def main():
    make = {"tuio": tuio, "osc": osc}[sys.argv[1]]
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    count = 0
    while True:
        count += 1
        try:
            sender.sendto(make(count), ("127.0.0.1", int(sys.argv[2])))
        except ConnectionRefusedError:  # nobody receives the datagrams yet
            pass
        time.sleep(0.02)


if __name__ == "__main__":
    main()
