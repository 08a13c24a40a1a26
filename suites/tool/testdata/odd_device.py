"""The devices of suites/second_hand with one oddity each: odd_device.py ODDITY PROTOCOL TTY|PORT [BYTES].

  separate     coils, inputs and both kinds of registers are four tables of 65536 that have nothing in common
  no_writes    refuses each write (Modbus exception 04, XGT error 0190)
  mute_writes  does not answer a write
  repeats      answers by the request itself where function codes 05 and 06 are to be refused, as they are answered else
  stale        sends in front of each answer the one to the request before, once more
  dies         ends with exit status 3 at a request with these bytes, in hex
"""
import asyncio
import os
import sys
import types

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../second_hand"))

import device  # noqa: E402
from cnet import CnetServer  # noqa: E402
from memory import Memory  # noqa: E402
from modbus import BASES, AsciiServer, Functions, RtuServer, TcpServer  # noqa: E402
from terminal import open_raw  # noqa: E402

oddity, protocol, where = sys.argv[1:4]
SERVERS = {"modbus-rtu": RtuServer, "modbus-ascii": AsciiServer, "modbus-tcp": TcpServer}
TABLE = 65536


def die_at(request):
    if oddity == "dies" and bytes.fromhex(sys.argv[4]) in bytes(request):
        sys.stderr.write("the device has burnt out\n")
        sys.stderr.flush()
        os._exit(3)


class OddFunctions(Functions):
    """The functions of Modbus."""

    def answer(self, pdu):
        die_at(pdu)
        if pdu[0] in (5, 6, 15, 16):
            if oddity == "mute_writes":
                return None
            if oddity == "no_writes":
                return bytes([pdu[0] | 0x80, 4])
        reply = super().answer(pdu)
        return pdu if oddity == "repeats" and pdu[0] in (5, 6) and reply and reply[0] & 0x80 else reply


class SeparateTables(OddFunctions):
    def __init__(self, memory, words_written, bases):
        super().__init__(memory, words_written, bases)
        self.tables = {use: [0 if use.startswith("bit") else bytes(2)] * TABLE for use in bases}

    def span(self, use):
        return TABLE

    def read_bits(self, function, address, count):
        use = "bit_write" if function == 1 else "bit_read"
        self.check(use, address, count, 2000)
        bits = self.tables[use][address:address + count]
        data = bytes(sum(bit << i for i, bit in enumerate(bits[k:k + 8])) for k in range(0, count, 8))
        return bytes([len(data)]) + data

    def read_words(self, function, address, count):
        use = "word_write" if function == 3 else "word_read"
        self.check(use, address, count, 125)
        return bytes([2 * count]) + b"".join(self.tables[use][address:address + count])

    def write_bits(self, address, values):
        self.check("bit_write", address, len(values), 1976)
        self.tables["bit_write"][address:address + len(values)] = values

    def write_words(self, address, values):
        self.check("word_write", address, len(values), 124)
        self.tables["word_write"][address:address + len(values)] = values


class OddCnet(CnetServer):
    """XGT Cnet."""
    last = b""

    def frame(self, frame):
        die_at(frame)
        if frame[3:4] in b"wW":
            if oddity == "mute_writes":
                return None
            if oddity == "no_writes":
                refusal = b"\x15" + frame[1:6] + b"0190\x03"
                return refusal + (b"%02X" % (sum(refusal) & 255) if frame[3:4] == b"w" else b"")
        reply = super().frame(frame)
        if oddity == "stale" and reply:
            reply, self.last = self.last + reply, reply
        return reply


def make():
    if protocol == "xgt-cnet":
        return OddCnet(Memory(), 1)
    server = SERVERS[protocol](Memory())
    functions = SeparateTables if oddity == "separate" else OddFunctions
    server.functions = functions(server.functions.memory, server.functions.words_written, BASES)
    return server


server = make()
if where.isdigit():
    asyncio.run(device.serve_network(server, types.SimpleNamespace(listen="127.0.0.1:" + where, udp=None, connections=4,
                                                                   wait=100)))
else:
    handle = open_raw(where)
    device.serve_serial(server, handle)
