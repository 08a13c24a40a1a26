"""pymodbus_stimulated.py rtu|ascii TTY, or tcp PORT: a master made of pymodbus, as a device under test in the client role.

What it asks comes as lines of JSON on standard input (README 'The module as client'): at once, or at the pace of a clock
until "over". Ends with its input; what failed is told on standard error.
"""
import json
import os
import select
import socket
import sys
import time

from pymodbus.client import ModbusSerialClient, ModbusTcpClient
from pymodbus.exceptions import ConnectionException
from pymodbus.transaction import ModbusAsciiFramer, ModbusRtuFramer

PERIODS = {"F90": 0.02, "F92": 0.2, "F93": 1.0, "_T20MS": 0.02, "_T200MS": 0.2, "_T1S": 1.0}


def address_of(value):
    """A key may hold one text, or a list of one."""
    return value[0] if isinstance(value, list) else value


def elements(digits, size):
    return [int(digits[at:at + size], 16) for at in range(0, len(digits), size)]


def connect_again_if_closed(line):
    """A connection that the partner has closed between two requests is made anew."""
    try:
        if line.socket and line.socket.recv(1, socket.MSG_PEEK | socket.MSG_DONTWAIT):
            return
    except BlockingIOError:
        return
    except OSError:
        pass
    line.close()
    line.connect()


def ask(line, request):
    if isinstance(line, ModbusTcpClient):
        connect_again_if_closed(line)
    block = request["block"]
    writes = block.get("function", "read") == "write"
    partner = address_of(block["save" if writes else "read"])  # "0x40001"
    table, address = partner[2], int(partner[3:], 16)
    count, slave = block.get("size", 1), block.get("station", 1)
    if writes:
        digits = request["values"][address_of(block["read"])]
        single = block.get("command", "single") == "single"
        if table == "0":
            bits = [bool(bit) for bit in elements(digits, 2)]
            reply = line.write_coil(address, bits[0], slave) if single else line.write_coils(address, bits, slave)
        else:
            words = elements(digits, 4)
            reply = line.write_register(address, words[0], slave) if single else line.write_registers(address, words, slave)
    else:
        read = {"0": line.read_coils, "1": line.read_discrete_inputs, "3": line.read_input_registers, "4": line.read_holding_registers}
        reply = read[table](address, count, slave)
    if reply.isError():
        print(f"pymodbus_stimulated: {partner}: {reply}", file=sys.stderr)


class Jobs:
    """What is asked at the pace of a clock."""

    def __init__(self, line):
        self.line = line
        self.jobs = []

    def take(self, text):
        request = json.loads(text)
        if request.get("over"):
            self.jobs = []
            return
        period = PERIODS.get(request["block"].get("flag"))
        if period:
            self.jobs.append([time.monotonic() + period, period, request])
        else:
            ask(self.line, request)

    def run_due(self):
        """The time until the next is due; None: there is none."""
        for job in self.jobs:
            if time.monotonic() >= job[0]:
                job[0] += job[1]
                ask(self.line, job[2])
        return max(0.0, min(job[0] for job in self.jobs) - time.monotonic()) if self.jobs else None


def main():
    mode, where = sys.argv[1:]
    if mode == "tcp":
        line = ModbusTcpClient("127.0.0.1", port=int(where), timeout=1, retries=0)
    else:
        line = ModbusSerialClient(port=where, framer={"rtu": ModbusRtuFramer, "ascii": ModbusAsciiFramer}[mode],
                                  baudrate=9600, bytesize=8, parity="N", stopbits=1, timeout=1, retries=0)
    if not line.connect():
        sys.exit(f"pymodbus_stimulated: cannot open {where}")
    jobs, heard, wait = Jobs(line), b"", None
    while True:
        if select.select([0], [], [], wait)[0]:
            more = os.read(0, 4096)
            if not more:
                return
            heard += more
        *lines, heard = heard.split(b"\n")
        for text in lines:
            try:
                jobs.take(text)
            except (ValueError, KeyError, IndexError, ConnectionException) as error:
                print(f"pymodbus_stimulated: cannot take the line {text.decode()}: {error!r}", file=sys.stderr)
        try:
            wait = jobs.run_due()
        except ConnectionException as error:
            print(f"pymodbus_stimulated: {error}", file=sys.stderr)
            wait = 0


main()
