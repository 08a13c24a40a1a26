"""pymodbus_server.py rtu|ascii TTY, or tcp PORT [separate]: a server made of pymodbus, as a device under test that nobody here has written.

Station 1; by TCP whatever the unit. Its memory is laid out as that of an XBC-DxxxH with all four bases at M0: coils and inputs are the bits of
the words, input registers are the holding registers. `separate`: four tables that have nothing in common, as most Modbus devices have them.
"""
import sys

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.datastore.store import BaseModbusDataBlock
from pymodbus.server import StartSerialServer, StartTcpServer
from pymodbus.transaction import ModbusAsciiFramer, ModbusRtuFramer

WORDS = 1024  # M of an XBC-DxxxH
BITS = 9999   # data addresses


class BitsOfWords(BaseModbusDataBlock):
    """Bit i is bit i % 16 of word i / 16."""

    def __init__(self, words):
        self.words = words

    def validate(self, address, count=1):
        return 0 <= address and count >= 0 and address + count <= BITS

    def getValues(self, address, count=1):
        return [bool(self.words.values[i // 16] >> i % 16 & 1) for i in range(address, address + count)]

    def setValues(self, address, values):
        for i, value in enumerate(values if isinstance(values, list) else [values], address):
            mask = 1 << i % 16
            self.words.values[i // 16] = self.words.values[i // 16] & ~mask | (mask if value else 0)


def overlapping_tables():
    words = ModbusSequentialDataBlock(0, [0] * WORDS)
    bits = BitsOfWords(words)
    return ModbusSlaveContext(di=bits, co=bits, hr=words, ir=words, zero_mode=True)


def separate_tables():
    def table():
        return ModbusSequentialDataBlock(0, [0] * BITS)
    return ModbusSlaveContext(di=table(), co=table(), hr=table(), ir=table(), zero_mode=True)


def main():
    mode, where = sys.argv[1:3]
    memory = separate_tables() if "separate" in sys.argv[3:] else overlapping_tables()
    if mode == "tcp":
        StartTcpServer(context=ModbusServerContext(slaves=memory, single=True), address=("127.0.0.1", int(where)))
        return
    StartSerialServer(
        context=ModbusServerContext(slaves={1: memory}, single=False),
        framer={"rtu": ModbusRtuFramer, "ascii": ModbusAsciiFramer}[mode],
        port=where, baudrate=9600, bytesize=8, parity="N", stopbits=1, ignore_missing_slaves=True)


main()
