"""A server of XGT FEnet, written from chapters 5 and 6 of the XBL-EMTA manual alone, as another maker would; standard library only.

fenet_server.py PORT [--udp-port PORT] [--mode run|stop|error|debug] [--wait SECONDS]

TCP and UDP, on one port unless told. Where the manual leaves room this maker has chosen:
- bits are counted through the area in decimal: %MX20 is bit 4 of %MW1;
- names of all blocks stand before the data of all blocks;
- refusals have error status FFFF and the codes of `Code`;
- what cannot be a request (other company ID, source, a length past LONGEST) closes the connection and is dropped over UDP;
- the check sum, reserved words, position and information of a request are not looked at.
"""
import argparse
import asyncio
import enum
import socket
import struct

CHANNELS = 4
LONGEST = 1024       # body of a request
MOST_BYTES = 512     # of data in a request (Table 5-1)
COMPANIES = (b"LSIS-XGT\0\0", b"LGIS-GLOFA")
HEADER = struct.Struct("<10sHBBHHBB")
SIZES = {0: ("X", 1), 1: ("B", 1), 2: ("W", 2), 3: ("D", 4), 4: ("L", 8)}
CONTINUOUS = 0x14
STATUS = {"run": 1, "stop": 2, "error": 4, "debug": 8}
WORDS = {"P": 1024, "M": 1024, "K": 4096, "F": 1024, "L": 2048, "N": 10240, "D": 10240, "U": 1024, "Z": 128, "R": 10240,
         "T": 1024, "C": 1024}
TYPES_OF_AREAS = {"T": "XBW", "C": "XBW", "D": "BW"}  # notes of 5.2.4; other areas have all


class Code(enum.IntEnum):
    COMMAND = 0x01
    DATA_TYPE = 0x02
    BLOCKS = 0x03
    NAME = 0x04
    AREA = 0x05
    ADDRESS = 0x06
    COUNT = 0x07
    VALUE = 0x08
    LENGTH = 0x09
    PROTECTED = 0x0A


class Refusal(Exception):
    """Its code says why."""


class Memory:
    def __init__(self):
        self.words = {area: bytearray(2 * count) for area, count in WORDS.items()}
        self.contacts = {area: bytearray(WORDS[area] // 8) for area in "TC"}

    def place(self, name, letter, size):
        """The bytes, and the number in them that `name` has (bit or byte)."""
        if not 4 <= len(name) <= 16 or name[:1] != b"%" or not name[3:].isdigit():
            raise Refusal(Code.NAME)
        area = chr(name[1])
        if area not in WORDS:
            raise Refusal(Code.AREA)
        if chr(name[2]) != letter or letter not in TYPES_OF_AREAS.get(area, "XBWDL"):
            raise Refusal(Code.DATA_TYPE)
        number = int(name[3:])
        if letter == "X":
            return self.contacts.get(area, self.words[area]), number
        return self.words[area], number * size

    def bounded(self, data, start, count):
        if start + count > len(data):
            raise Refusal(Code.ADDRESS)

    def read(self, name, letter, size):
        data, number = self.place(name, letter, size)
        if letter == "X":
            self.bounded(data, number // 8, 1)
            return bytes([data[number // 8] >> number % 8 & 1])
        self.bounded(data, number, size)
        return bytes(data[number:number + size])

    def writable(self, name, letter, size, value):
        """Where to write; nothing is written if one block of a request is wrong."""
        data, number = self.place(name, letter, size)
        if name[1:2] == b"F":
            raise Refusal(Code.PROTECTED)
        if letter == "X":
            self.bounded(data, number // 8, 1)
            if value[0] > 1:
                raise Refusal(Code.VALUE)
        else:
            self.bounded(data, number, len(value))
        return data, number

    @staticmethod
    def write(data, number, letter, value):
        if letter != "X":
            data[number:number + len(value)] = value
        elif value[0]:
            data[number // 8] |= 1 << number % 8
        else:
            data[number // 8] &= ~(1 << number % 8)


class Body:
    """What is still to be read of a request."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, count):
        if self.at + count > len(self.data):
            raise Refusal(Code.LENGTH)
        self.at += count
        return self.data[self.at - count:self.at]

    def word(self):
        return struct.unpack("<H", self.take(2))[0]

    def counted(self):
        return self.take(self.word())

    def end(self):
        if self.at != len(self.data):
            raise Refusal(Code.LENGTH)


class Plc:
    """Answers frames out of its memory."""

    def __init__(self, mode):
        self.memory = Memory()
        self.status = STATUS[mode]

    def reply(self, header, body):
        company, _, _, _, invoke, _, _, _ = HEADER.unpack(header)
        answer = self.answer(body)
        made = HEADER.pack(company, self.status << 8 | 2, 0xB0, 0x11, invoke, len(answer), 2, 0)
        return made[:19] + bytes([sum(made) & 0xFF]) + answer

    def answer(self, body):
        head = bytes([(body[0] + 1) & 0xFF if body else 1, 0]) + body[2:4].ljust(2, b"\0") + b"\0\0"
        try:
            return head + b"\0\0" + self.data(Body(body))
        except Refusal as refusal:
            return head + b"\xff\xff" + struct.pack("<H", refusal.args[0])

    def data(self, body):
        command, data_type = body.word(), body.word()
        body.take(2)
        if command not in (0x54, 0x58):
            raise Refusal(Code.COMMAND)
        if data_type not in SIZES and data_type != CONTINUOUS:
            raise Refusal(Code.DATA_TYPE)
        blocks = body.word()
        if not 1 <= blocks <= (1 if data_type == CONTINUOUS else 16):
            raise Refusal(Code.BLOCKS)
        names = [body.counted() for _ in range(blocks)]
        if data_type == CONTINUOUS:
            return self.read_bytes(names[0], body) if command == 0x54 else self.write_bytes(names[0], body)
        letter, size = SIZES[data_type]
        if command == 0x54:
            body.end()
            found = [self.memory.read(name, letter, size) for name in names]
            return struct.pack("<H", blocks) + b"".join(struct.pack("<H", size) + value for value in found)
        values = [body.counted() for _ in names]
        body.end()
        if any(len(value) != size for value in values):
            raise Refusal(Code.COUNT)
        places = [self.memory.writable(name, letter, size, value) for name, value in zip(names, values)]
        for (data, number), value in zip(places, values):
            self.memory.write(data, number, letter, value)
        return struct.pack("<H", blocks)

    def read_bytes(self, name, body):
        count = body.word()
        body.end()
        if not 1 <= count <= MOST_BYTES:
            raise Refusal(Code.COUNT)
        data, number = self.memory.place(name, "B", 1)
        self.memory.bounded(data, number, count)
        return struct.pack("<HH", 1, count) + bytes(data[number:number + count])

    def write_bytes(self, name, body):
        value = body.counted()
        body.end()
        if not 1 <= len(value) <= MOST_BYTES:
            raise Refusal(Code.COUNT)
        self.memory.write(*self.memory.writable(name, "B", 1, value), "B", value)
        return b"\x01\x00"


def length_of(header):
    """Of the body, or None if this is no request."""
    company, _, _, source, _, length, _, _ = HEADER.unpack(header)
    return length if company in COMPANIES and source == 0x33 and length <= LONGEST else None


class Channel(asyncio.Protocol):
    """A connection: ended with RST when the client sends FIN, when it is the fifth, and when nothing is asked for too long (6.2.2, 6.3.1)."""

    def __init__(self, plc, channels, wait):
        self.plc, self.channels, self.wait = plc, channels, wait
        self.transport = self.timer = None
        self.received = b""

    def connection_made(self, transport):
        self.transport = transport
        if len(self.channels) == CHANNELS:
            self.reset()
            return
        self.channels.add(self)
        transport.get_extra_info("socket").setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.await_request()

    def await_request(self):
        if self.timer:
            self.timer.cancel()
        self.timer = asyncio.get_running_loop().call_later(self.wait, self.reset)

    def reset(self):
        self.transport.get_extra_info("socket").setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.transport.abort()

    def data_received(self, data):
        self.received += data
        while len(self.received) >= 20:
            length = length_of(self.received[:20])
            if length is None:
                self.reset()
                return
            if len(self.received) < 20 + length:
                return
            self.transport.write(self.plc.reply(self.received[:20], self.received[20:20 + length]))
            self.received = self.received[20 + length:]
            self.await_request()

    def eof_received(self):
        self.reset()

    def connection_lost(self, error):
        self.channels.discard(self)
        if self.timer:
            self.timer.cancel()


class Datagrams(asyncio.DatagramProtocol):
    def __init__(self, plc):
        self.plc = plc
        self.transport = None

    def connection_made(self, transport):
        self.transport = transport

    def datagram_received(self, data, address):
        if len(data) >= 20 and length_of(data[:20]) == len(data) - 20:
            self.transport.sendto(self.plc.reply(data[:20], data[20:]), address)


async def serve(options):
    plc, channels = Plc(options.mode), set()
    loop = asyncio.get_running_loop()
    await loop.create_datagram_endpoint(lambda: Datagrams(plc), local_addr=("127.0.0.1", options.udp_port or options.port))
    server = await loop.create_server(lambda: Channel(plc, channels, options.wait), "127.0.0.1", options.port, backlog=1024)
    await server.serve_forever()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("port", type=int)
    parser.add_argument("--udp-port", type=int)
    parser.add_argument("--mode", choices=STATUS, default="run")
    parser.add_argument("--wait", type=float, default=15, help="reception waiting time in seconds")
    try:
        asyncio.run(serve(parser.parse_args()))
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
