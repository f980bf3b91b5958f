#!/usr/bin/env python3
"""Follows a topic of MERLIN, or sends it a command, over ZeroMQ (Debian: python3-zmq).

    read_status.py merlin-devices sample 10      prints 10 documents of the topic "sample"
    read_status.py merlin-wall --command status  sends a command and prints its result

The first argument is a shared-memory segment: it holds the addresses of the two sockets.
"""
import json, mmap, struct, sys
import zmq

TIMEOUT_MS = 5000

def endpoint(segment, wanted):
    """The text of one field of the segment; daemon/shm/read_merlin.py shows how to read others."""
    with open(f"/dev/shm/{segment}", "rb") as file:
        memory = mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ)
    magic, version, _, _, table, fields, size, _ = struct.unpack_from("<IIQQIIII", memory)
    if magic != 0x4E4C524D or version != 6:
        sys.exit(f"read_status.py: {segment} is not a segment of MERLIN that this program knows")
    for i in range(fields):
        name, _, type_, _, _, offset = struct.unpack_from("<48s24s8sIII", memory, table + i * size)
        if name.rstrip(b"\0").decode() == wanted:
            text, = struct.unpack_from(type_.rstrip(b"\0").decode(), memory, offset)
            return text.split(b"\0")[0].decode()
    sys.exit(f"read_status.py: {segment} has no field {wanted}")

def connect(kind, address):
    socket = zmq.Context.instance().socket(kind)
    socket.rcvtimeo, socket.linger = TIMEOUT_MS, 0
    socket.connect(address)
    return socket

def follow(segment, topic, count):
    socket = connect(zmq.SUB, endpoint(segment, "segment.status_endpoint"))
    socket.subscribe(topic)
    for _ in range(count):
        name, document = socket.recv_multipart()
        print(name.decode(), json.dumps(json.loads(document)), flush=True)

def command(segment, name, argument):
    socket = connect(zmq.REQ, endpoint(segment, "segment.command_endpoint"))
    socket.send_json({"command": name} | ({"argument": argument} if argument else {}))
    reply = socket.recv_json()
    if not reply["ok"]:
        sys.exit(f"read_status.py: {reply['error']}")
    print(json.dumps(reply["result"]))

if len(sys.argv) < 4:
    sys.exit(__doc__)
try:
    if sys.argv[2] == "--command":
        command(sys.argv[1], sys.argv[3], sys.argv[4] if len(sys.argv) > 4 else None)
    else:
        follow(sys.argv[1], sys.argv[2], int(sys.argv[3]))
except zmq.Again:
    sys.exit(f"read_status.py: no answer within {TIMEOUT_MS / 1000:g} s")
