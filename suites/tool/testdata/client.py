"""A small XGT client for the tests of the built tool: single words, XGT, with BCC.

  client.py TTY                  asks for the blocks that lines of --stimulus on its standard input name
  client.py LINK AUX BLOCKS MEMORY
                                 a PLC with two ports, ptys linked from LINK and AUX: P2P blocks (JSON) set up, on LINK as
                                 client, and its memory served on AUX, flags of P2P 1 (L word 512 + 6 b) included;
                                 MEMORY is what it holds at first: {"%MW100": "5ABC"}
  FIELDPROOF_CLIENT=twice|mute|late
                                 asks twice, asks nothing, asks at the pace of a clock once more after it was to stop
  FIELDPROOF_PERIOD=SECONDS      of its clock of 200 ms
"""
import json
import os
import select
import sys
import time
import tty

ENQ, ACK, NAK, EOT, ETX = b"\x05", b"\x06", b"\x15", b"\x04", b"\x03"
BEHAVIOUR = os.environ.get("FIELDPROOF_CLIENT", "")
TIME_OUT = 0.2
PERIOD = float(os.environ.get("FIELDPROOF_PERIOD", "0.2"))
memory = {}  # words by "%MW100"; a bit "%MX1234" is bit 4 of "%MW123"


def load(address):
    if address[2] != "X":
        return memory.get(address, "0000")
    return "%02X" % (int(load(word_of(address)), 16) >> int(address[-1], 16) & 1)


def store(address, digits):
    if address[2] != "X":
        memory[address] = digits
        return
    bit = 1 << int(address[-1], 16)
    word = int(load(word_of(address)), 16) & ~bit
    memory[word_of(address)] = "%04X" % (word | bit * int(digits, 16))


def word_of(bit):
    return "%%%sW%d" % (bit[1], int(bit[3:-1] or "0"))


def checked(frame):
    return frame + b"%02X" % (sum(frame) % 256)


def name(address):
    return b"%02X" % len(address) + address.encode()


def request(block, values):
    head = ENQ + b"%02X" % block["station"]
    count = b"%02X" % len(block["read"])
    if block["function"] == "read":
        return checked(head + b"rSS" + count + b"".join(name(one) for one in block["read"]) + EOT)
    pairs = zip(block["read"], block["save"])
    return checked(head + b"wSS" + count + b"".join(name(save) + values[read].encode() for read, save in pairs) + EOT)


def read_frame(port, limit):
    """A frame and its BCC, or nothing within `limit`."""
    data, until = b"", time.monotonic() + limit
    while not (len(data) > 2 and data[-3:-2] in (EOT, ETX)):
        if not select.select([port], [], [], max(0.0, until - time.monotonic()))[0]:
            return b""
        data += os.read(port, 1)
    return data


def save(block, reply):
    """The values of a good reply; whether it was one."""
    if not reply.startswith(ACK) or checked(reply[:-2]) != reply or reply[1:3] != b"%02X" % block["station"]:
        return False
    data = reply[8:]
    if block["function"] == "read":
        for address in block["save"]:
            memory[address] = data[2:6].decode()
            data = data[6:]
    return True


def count(block, good):
    first = 512 + 6 * block["block"]
    memory["%%LW%d" % first] = "0001" if good else "0002"
    counter = "%%LW%d" % (first + (2 if good else 4))
    memory[counter] = "%04X" % (int(memory.get(counter, "0"), 16) + 1)


def ask(port, block, values):
    for _ in range(2 if BEHAVIOUR == "twice" else 0 if BEHAVIOUR == "mute" else 1):
        os.write(port, request(block, values))
        count(block, save(block, read_frame(port, TIME_OUT)))


def serve(frame):
    """The second port: one word or bit, read or written."""
    size = int(frame[8:10], 16)
    address = frame[10:10 + size].decode()
    head = ACK + frame[1:6]
    if frame[3:4].upper() == b"W":
        store(address, frame[10 + size:frame.index(EOT)].decode())
        answer = head + ETX
    else:
        value = load(address).encode()
        answer = head + b"01%02X" % (len(value) // 2) + value + ETX
    return checked(answer) if frame[3:4].islower() else answer


def terminal(link):
    port, slave = os.openpty()
    tty.setraw(slave)
    os.symlink(os.ttyname(slave), link)
    return port


def serve_one(aux):
    """One request of the second port; the address where it wrote."""
    frame = b""
    while not frame.endswith(EOT):
        frame += os.read(aux, 1)
    if frame[3:4].islower():
        frame += os.read(aux, 1) + os.read(aux, 1)
    os.write(aux, serve(frame))
    size = int(frame[8:10], 16)
    return frame[10:10 + size].decode() if frame[3:4].upper() == b"W" else None


class Clock:
    """What asks every 200 ms."""

    def __init__(self):
        self.asks = {}  # by block: what, with which values
        self.due = time.monotonic()

    def start(self, block, values):
        self.asks[block["block"]] = (block, values)
        self.due = time.monotonic()

    def wait(self):
        return max(0.0, self.due - time.monotonic()) if self.asks else None

    def tick(self, port):
        if not self.asks or time.monotonic() < self.due:
            return
        for block, values in self.asks.values():
            ask(port, block, values)
        self.due += PERIOD


def stimulated(port):
    lines, clock = b"", Clock()
    while True:
        told = select.select([0], [], [], clock.wait())[0]
        clock.tick(port)
        if not told:
            continue
        more = os.read(0, 4096)
        if not more:
            return
        *complete, lines = (lines + more).split(b"\n")
        for line in map(json.loads, complete):
            if line.get("over"):
                if BEHAVIOUR == "late" and clock.asks:
                    time.sleep(0.05)
                    clock.due = 0
                    clock.tick(port)
                clock = Clock()
            elif "block" not in line:
                continue  # it answers nothing to "hello", and is told no more than what to ask
            elif line["block"]["flag"] == "F92":
                clock.start(line["block"], line["values"])
            else:
                ask(port, line["block"], line["values"])


def plc(port, aux, blocks):
    clock, on = Clock(), set()
    for block in blocks:
        if block["flag"] == "F92":
            clock.start(block, {})
    while True:
        if select.select([aux], [], [], clock.wait())[0]:
            written = serve_one(aux)
            for block in blocks:
                flag = block["flag"]
                if not written or not flag.startswith("%"):
                    continue
                rises = int(load(flag), 16) and flag not in on
                (on.add if int(load(flag), 16) else on.discard)(flag)
                if rises:
                    ask(port, block, {one: load(one) for one in block["read"]})
        clock.tick(port)


def main():
    if len(sys.argv) == 2:
        port = os.open(sys.argv[1], os.O_RDWR | os.O_NOCTTY)
        tty.setraw(port, 0)
        return stimulated(port)
    port, aux = terminal(sys.argv[1]), terminal(sys.argv[2])
    memory.update(json.loads(sys.argv[4]) if len(sys.argv) > 4 else {})
    print("ready", flush=True)
    plc(port, aux, json.loads(sys.argv[3]))


main()
