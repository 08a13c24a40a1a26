"""pymodbus_client.py rtu|ascii TTY, or tcp PORT: a master made of pymodbus. What it writes one way it reads another."""
import sys

from pymodbus.client import ModbusSerialClient, ModbusTcpClient
from pymodbus.transaction import ModbusAsciiFramer, ModbusRtuFramer

failures = 0


def check(got, due, what):
    global failures
    if got == due:
        return
    failures += 1
    print(f"{what}: expected {due}, got {got}", file=sys.stderr)


def word_bits(*words):
    return [bool(word >> i & 1) for word in words for i in range(16)]


def main():
    mode, where = sys.argv[1:]
    if mode == "tcp":
        line = ModbusTcpClient("127.0.0.1", port=int(where), timeout=2)
    else:
        line = ModbusSerialClient(port=where, framer={"rtu": ModbusRtuFramer, "ascii": ModbusAsciiFramer}[mode],
                                  baudrate=9600, bytesize=8, parity="N", stopbits=1, timeout=2)
    check(line.connect(), True, "open the line")

    check(line.write_registers(100, [0x9ABC, 0x1234], slave=1).count, 2, "10 writes two registers")
    check(line.read_coils(1600, 32, slave=1).bits, word_bits(0x9ABC, 0x1234), "01 reads what 10 wrote")

    line.write_coils(3200, [True, False, True, True, False, False, True, True, True, False], slave=1)
    check(line.read_holding_registers(200, 1, slave=1).registers, [0x01CD], "03 reads what 0F wrote")
    line.write_coil(3215, True, slave=1)
    check(line.read_holding_registers(200, 1, slave=1).registers, [0x81CD], "03 reads what 05 wrote")
    line.write_register(201, 0x8001, slave=1)
    check(line.read_coils(3216, 16, slave=1).bits, word_bits(0x8001), "01 reads what 06 wrote")

    check(line.read_input_registers(0, 2, slave=1).registers, [0, 0], "04 reads P, which nobody wrote")
    check(len(line.read_holding_registers(0, 125, slave=1).registers), 125, "03 reads 125 registers")
    check(len(line.read_discrete_inputs(0, 2000, slave=1).bits), 2000, "02 reads 2000 inputs")
    check(line.read_holding_registers(1024, 1, slave=1).exception_code, 2, "03 past the end is exception 02")
    line.close()
    return 0 if failures == 0 else 1


sys.exit(main())
