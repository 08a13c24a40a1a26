"""A client of XGT FEnet servers, written from chapters 5 and 6 of the XBL-EMTA manual alone; standard library only.

fenet_client.py HOST:PORT [--udp] read %MW100 %DW0 ...
fenet_client.py HOST:PORT [--udp] write %MW100=0x1234 ...
fenet_client.py HOST:PORT [--udp] read-block %MB200 COUNT
fenet_client.py HOST:PORT [--udp] write-block %MB200 HEX

Every field of a reply that the manual states is checked; a reply that breaks it raises BadReply.
"""
import argparse
import asyncio
import struct
import sys

COMPANIES = {"LSIS-XGT": b"LSIS-XGT\0\0", "LGIS-GLOFA": b"LGIS-GLOFA"}  # Table 5-5
READ, WRITE = 0x54, 0x58  # a reply is one more (Table 5-3, 5.2.4)
CONTINUOUS = 0x14
TYPES = {"X": (0, 1), "B": (1, 1), "W": (2, 2), "D": (3, 4), "L": (4, 8)}  # data type, bytes of data
CPU_INFORMATION = {0xA0, 0xA4, 0xA8, 0xB0, 0xB4}
HEADER = struct.Struct("<10sHBBHHBB")
LONGEST_DATAGRAM = 65535


class BadReply(Exception):
    """What came is no reply of a server as the manual has it."""


class Refused(Exception):
    """The server answers with an error status, and a code as data."""

    def __init__(self, status, code):
        super().__init__(f"error status 0x{status:04X}, code 0x{code:04X}")
        self.status, self.code = status, code


def demand(holds, what):
    if not holds:
        raise BadReply(what)


def byte_sum(header):
    """The check sum: 'Application Header's Byte Sum', which three of the four printed frames carry."""
    return sum(header[:19]) & 0xFF


def frame(company, invoke, body):
    header = HEADER.pack(company, 0, 0xA0, 0x33, invoke, len(body), 0, 0)
    return header[:19] + bytes([byte_sum(header)]) + body


def request_body(command, data_type, names, values=()):
    """Names with their lengths, then values with theirs."""
    body = bytes([command, 0, data_type, 0, 0, 0]) + struct.pack("<H", len(names))
    for name in names:
        body += struct.pack("<H", len(name)) + name.encode("ascii")
    for value in values:
        body += struct.pack("<H", len(value)) + value
    return body


def check_header(header, invoke):
    """The length of the body (Table 5-3)."""
    company, plc, cpu, source, copied, length, _, check_sum = HEADER.unpack(header)
    demand(company in COMPANIES.values(), f"company ID {company}")
    demand(plc >> 13 == 0, f"PLC information 0x{plc:04X} has reserved bits")
    demand(plc >> 8 & 0x1F in (1, 2, 4, 8), f"PLC information 0x{plc:04X} names no system status")
    demand(cpu in CPU_INFORMATION, f"CPU information 0x{cpu:02X}")
    demand(source == 0x11, f"source of frame 0x{source:02X}, not 0x11")
    demand(copied == invoke, f"invoke ID {copied}, not {invoke}")
    demand(check_sum == byte_sum(header), f"check sum 0x{check_sum:02X}, not 0x{byte_sum(header):02X}")
    return length


def check_body(body, command, data_type):
    """What follows the error status of a reply without error (Table 5-4)."""
    demand(len(body) >= 10, f"a body of {len(body)} bytes")
    demand(body[:2] == bytes([command + 1, 0]), f"command {body[:2].hex()}")
    demand(body[2:4] == bytes([data_type, 0]), f"data type {body[2:4].hex()}")
    status, first = struct.unpack_from("<HH", body, 6)
    if status:
        demand(len(body) == 10, f"{len(body) - 8} bytes of data after an error status")
        raise Refused(status, first)
    return body[8:]


class TcpLink:
    def __init__(self, reader, writer):
        self.reader, self.writer = reader, writer

    def send(self, data):
        self.writer.write(data)

    async def receive(self, invoke):
        """A body whose header is right."""
        header = await self.reader.readexactly(20)
        return await self.reader.readexactly(check_header(header, invoke))

    async def stray(self, seconds):
        """What comes though nobody waits for it."""
        try:
            return await asyncio.wait_for(self.reader.read(4096), seconds)
        except asyncio.TimeoutError:
            return b""

    async def close(self):
        """FIN, and what the server answers to it; its channel is free then."""
        try:
            self.writer.write_eof()
            await asyncio.wait_for(self.reader.read(), 5)
        except (OSError, asyncio.TimeoutError):
            pass
        self.writer.transport.abort()


class UdpLink(asyncio.DatagramProtocol):
    def __init__(self):
        self.transport = None
        self.received = asyncio.Queue()

    def connection_made(self, transport):
        self.transport = transport

    def datagram_received(self, data, address):
        self.received.put_nowait(data)

    def error_received(self, error):
        self.received.put_nowait(error)

    def send(self, data):
        self.transport.sendto(data)

    async def receive(self, invoke):
        data = await self.received.get()
        if isinstance(data, Exception):
            raise data
        demand(len(data) >= 20, f"a datagram of {len(data)} bytes")
        length = check_header(data[:20], invoke)
        demand(len(data) == 20 + length, f"length {length} in a datagram of {len(data)} bytes")
        return data[20:]

    async def stray(self, seconds):
        try:
            return await asyncio.wait_for(self.received.get(), seconds)
        except asyncio.TimeoutError:
            return b""

    async def close(self):
        self.transport.close()


class Client:
    """One connection; one request at a time. `patience` is how long a reply may take, in seconds."""

    def __init__(self, link, company="LSIS-XGT", patience=5.0):
        self.link, self.company, self.patience = link, COMPANIES[company], patience
        self.invoke = 0
        self.exchanges = 0

    @classmethod
    async def connect(cls, host, port, udp=False, **options):
        if udp:
            loop = asyncio.get_running_loop()
            _, link = await loop.create_datagram_endpoint(UdpLink, remote_addr=(host, port))
        else:
            link = TcpLink(*await asyncio.open_connection(host, port))
        return cls(link, **options)

    async def __aenter__(self):
        return self

    async def __aexit__(self, *_):
        await self.link.close()

    async def answer(self, command, data_type, invoke=None):
        """The data of the reply that is due."""
        body = await asyncio.wait_for(self.link.receive(self.invoke if invoke is None else invoke), self.patience)
        self.exchanges += 1
        return check_body(body, command, data_type)

    async def exchange(self, command, data_type, names, values=()):
        self.invoke = (self.invoke + 1) & 0xFFFF
        self.link.send(frame(self.company, self.invoke, request_body(command, data_type, names, values)))
        return await self.answer(command, data_type)

    async def read(self, *names):
        """Values of names of one type, as numbers."""
        data_type, size = TYPES[names[0][2]]
        data = await self.exchange(READ, data_type, names)
        return read_values(data, len(names), size)

    async def write(self, pairs):
        data_type, size = TYPES[pairs[0][0][2]]
        values = [value.to_bytes(size, "little") for _, value in pairs]
        data = await self.exchange(WRITE, data_type, [name for name, _ in pairs], values)
        demand(data == struct.pack("<H", len(pairs)), f"{data.hex()} acknowledges {len(pairs)} written blocks")

    async def read_block(self, name, count):
        """Continuous: the count of bytes follows the name (Table 5-8)."""
        self.invoke = (self.invoke + 1) & 0xFFFF
        body = request_body(READ, CONTINUOUS, [name]) + struct.pack("<H", count)
        self.link.send(frame(self.company, self.invoke, body))
        return read_blocks(await self.answer(READ, CONTINUOUS), 1, count)[0]

    async def write_block(self, name, data):
        acknowledged = await self.exchange(WRITE, CONTINUOUS, [name], [data])
        demand(acknowledged == b"\x01\x00", f"{acknowledged.hex()} acknowledges one written block")


def read_blocks(data, blocks, size):
    """Blocks of `size` bytes, and nothing after them (Tables 5-7, 5-9)."""
    demand(struct.unpack_from("<H", data)[0] == blocks, f"{data[:2].hex()} is the count of {blocks} blocks")
    found, at = [], 2
    for _ in range(blocks):
        demand(data[at:at + 2] == struct.pack("<H", size), f"{data[at:at + 2].hex()} is the count of {size} bytes")
        found.append(data[at + 2:at + 2 + size])
        at += 2 + size
    demand(at == len(data), f"{len(data)} bytes of data, not {at}")
    return found


def read_values(data, blocks, size):
    return [int.from_bytes(block, "little") for block in read_blocks(data, blocks, size)]


def address(text):
    host, _, port = text.rpartition(":")
    return host or "127.0.0.1", int(port)


async def run(options):
    what = options.what
    async with await Client.connect(*address(options.server), udp=options.udp) as client:
        if options.command == "read":
            for name, value in zip(what, await client.read(*what)):
                print(f"{name} = 0x{value:0{2 * TYPES[name[2]][1]}X}")
        elif options.command == "write":
            pairs = [pair.split("=") for pair in what]
            await client.write([(name, int(value, 0)) for name, value in pairs])
        elif options.command == "read-block":
            print((await client.read_block(what[0], int(what[1]))).hex())
        else:
            await client.write_block(what[0], bytes.fromhex(what[1]))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("server")
    parser.add_argument("--udp", action="store_true")
    parser.add_argument("command", choices=["read", "write", "read-block", "write-block"])
    parser.add_argument("what", nargs="+")
    try:
        asyncio.run(run(parser.parse_args()))
    except (Refused, BadReply, OSError, EOFError, asyncio.TimeoutError) as error:
        sys.exit(f"fenet_client: {type(error).__name__}: {error}")


if __name__ == "__main__":
    main()
