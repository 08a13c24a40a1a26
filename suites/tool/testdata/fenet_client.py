"""An XGT FEnet client for the tests of the built tool, in no one's code but its own: single variables and runs of bytes or
words, over TCP or UDP, for the blocks that lines of --stimulus on its standard input name.

  fenet_client.py TCP_PORT UDP_PORT    of a partner on 127.0.0.1
  FIELDPROOF_CLIENT=no_count           each request has the invoke id 1
  FIELDPROOF_CLIENT=any_id             a reply is taken whatever its invoke id is
  FIELDPROOF_CLIENT=big_endian         what is written goes out high byte first
"""
import json
import os
import select
import socket
import struct
import sys
import time

BEHAVIOUR = os.environ.get("FIELDPROOF_CLIENT", "")
SIZES = {"bit": 1, "byte": 1, "word": 2, "dword": 4, "lword": 8}
TYPES = {"bit": 0, "byte": 1, "word": 2, "dword": 3, "lword": 4, "continuous": 0x14}
READ, WRITE, TIME_OUT = 0x54, 0x58, 5.0


def word(value):
    return struct.pack("<H", value)


def name(address):
    return word(len(address)) + address.encode()


def body(block, values):
    reads, run = block["function"] == "read", block["command"] == "continuous"
    size = SIZES[block["type"]]
    command = word(READ if reads else WRITE) + word(TYPES["continuous" if run else block["type"]]) + word(0)
    partner = block["read" if reads else "save"]
    if run:
        partner = ["%%%sB%d" % (partner[0][1], int(partner[0][3:]) * size)]
    out = command + word(len(partner)) + b"".join(name(one) for one in partner)
    if reads:
        return out + (word(block["size"] * size) if run else b"")
    for own in block["read"]:
        data = bytes.fromhex(values[own])
        if BEHAVIOUR != "big_endian":
            data = b"".join(data[at:at + size][::-1] for at in range(0, len(data), size))
        out += word(len(data)) + data
    return out


class Channel:
    """One connection, opened at the first request and again after a failure; or a datagram port. One request at a time."""

    def __init__(self, port, stream):
        self.port, self.stream, self.socket, self.heard = port, stream, None, b""
        self.invoke, self.wanted = 0, {}  # by block
        self.until = self.block = None  # when the reply to the request under way is too late, and whose it is

    def close(self):
        if self.socket:
            self.socket.close()
        self.socket, self.until = None, None

    def go_on(self):
        """Sends the next request where none is under way."""
        if self.until or not self.wanted:
            return
        self.block = min(self.wanted)
        content = self.wanted.pop(self.block)
        self.invoke = 1 if BEHAVIOUR == "no_count" else self.invoke % 0xFFFF + 1
        header = b"LSIS-XGT\0\0" + word(0) + b"\xB0\x33" + word(self.invoke) + word(len(content)) + b"\0"
        if not self.socket:
            self.socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM if self.stream else socket.SOCK_DGRAM)
            self.socket.connect(("127.0.0.1", self.port))
            self.heard = b""
        self.until = time.monotonic() + TIME_OUT
        self.socket.sendall(header + bytes([sum(header) & 0xFF]) + content)

    def hear(self):
        data = self.socket.recv(4096)
        if not data and self.stream:
            return self.close()
        self.heard = self.heard + data if self.stream else data
        while len(self.heard) >= 20:
            size = 20 + struct.unpack_from("<H", self.heard, 16)[0]
            if len(self.heard) < size:
                break
            frame, self.heard = self.heard[:size], self.heard[size:]
            own = frame[14:16] == word(self.invoke) or BEHAVIOUR == "any_id"
            if frame[:10] == b"LSIS-XGT\0\0" and frame[13] == 0x11 and own:
                self.until = None

    def tick(self):
        if self.until and time.monotonic() >= self.until:
            self.close()


def told(line, channels, ports):
    if "hello" in line:
        print(json.dumps({"follows": ["transport", "busy"]}), flush=True)
    if "begin" in line or "over" in line:
        for channel in channels.values():
            channel.close()
        channels.clear()
    if "block" in line:
        block = line["block"]
        transport = block.get("transport", "tcp")
        channel = channels.setdefault(block["channel"], Channel(ports[transport], transport == "tcp"))
        if not (channel.until and channel.block == block["block"]):
            channel.wanted.setdefault(block["block"], body(block, line.get("values", {})))


def main():
    ports, channels, lines = {"tcp": int(sys.argv[1]), "udp": int(sys.argv[2])}, {}, b""
    while True:
        for channel in channels.values():
            channel.tick()
            try:
                channel.go_on()
            except OSError:
                channel.close()
        sockets = {one.socket: one for one in channels.values() if one.socket}
        due = [one.until for one in channels.values() if one.until]
        wait = max(0.0, min(due) - time.monotonic()) if due else None
        ready = select.select([0, *sockets], [], [], wait)[0]
        for one in ready:
            try:
                if one in sockets:
                    sockets[one].hear()
            except OSError:
                sockets[one].close()
        if 0 not in ready:
            continue
        more = os.read(0, 4096)
        if not more:
            return
        lines += more
        while b"\n" in lines:
            line, lines = lines.split(b"\n", 1)
            told(json.loads(line), channels, ports)


main()
