"""A small XGT client for the tests of the built tool: client.py TTY [AUX_LINK].

It reads the lines of --stimulus from its standard input and asks for the blocks that they name: single words, XGT, with
BCC. With AUX_LINK it serves its memory on a pty of its own, linked from there, as the second port of the same PLC, and
keeps the flags of P2P 1 (L word 512 + 6 b); there a condition flag that is written over the second port fires as well.
  FIELDPROOF_CLIENT=twice   asks twice
  FIELDPROOF_CLIENT=mute    asks nothing
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
memory = {}  # words by "%MW100"


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
        memory[address] = frame[10 + size:frame.index(EOT)].decode()
        answer = head + ETX
    else:
        answer = head + b"0102" + memory.get(address, "0000").encode() + ETX
    return checked(answer) if frame[3:4].islower() else answer


def main():
    port = os.open(sys.argv[1], os.O_RDWR | os.O_NOCTTY)
    tty.setraw(port, 0)
    aux = None
    if len(sys.argv) > 2:
        aux, slave = os.openpty()
        tty.setraw(slave)
        os.symlink(os.ttyname(slave), sys.argv[2])
    lines, clock = b"", None  # the block that runs by a clock, its values, when it asks next
    while True:
        wait = None if clock is None else max(0.0, clock[2] - time.monotonic())
        ready = select.select([0] + ([aux] if aux else []), [], [], wait)[0]
        if aux in ready:
            frame = b""
            while not frame.endswith(EOT) or frame[3:4].islower():
                frame += os.read(aux, 1)
                if len(frame) > 3 and frame[-3:-2] == EOT:
                    break
            os.write(aux, serve(frame))
        if clock and time.monotonic() >= clock[2]:
            ask(port, clock[0], clock[1])
            clock[2] += 0.2
        if 0 not in ready:
            continue
        more = os.read(0, 4096)
        if not more:
            break
        *complete, lines = (lines + more).split(b"\n")
        for line in complete:
            told = json.loads(line)
            if told.get("over"):
                clock = None
            elif told["block"]["flag"] == "F92":
                clock = [told["block"], told["values"], time.monotonic()]
            else:
                ask(port, told["block"], told["values"])


main()
