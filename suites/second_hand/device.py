#!/usr/bin/env python3
"""A second-hand XBC-H or LS Bus inverter: serves one protocol on a terminal or a TCP port, healthy or with one fault."""
import argparse
import asyncio
import os
import select
import socket
import struct
import sys

import faults
from cnet import CnetServer
from faults import fault
from fenet import FenetServer
from ls_bus import LsBusServer
from memory import AREAS, Memory
from modbus import BASES, AsciiServer, RtuServer, TcpServer
from terminal import open_raw

SERIAL = {'xgt-cnet': CnetServer, 'modbus-rtu': RtuServer, 'modbus-ascii': AsciiServer, 'ls-bus': LsBusServer}
NETWORK = {'modbus-tcp': TcpServer, 'xgt-fenet': FenetServer}


# ---- serial

def send(handle, data):
    while data:
        data = data[os.write(handle, data):]


def serve_serial(server, handle, control=False):
    while True:
        inputs = [handle, sys.stdin] if control else [handle]
        ready = select.select(inputs, [], [], server.gap_seconds if server.pending else None)[0]
        if sys.stdin in ready:
            line = sys.stdin.readline()     # a bench waits for the answer before its next line
            control = bool(line)
            if line:
                print(server.control(line), flush=True)
            continue
        if not ready:
            send(handle, server.gap())
            continue
        try:
            data = os.read(handle, 4096)
        except OSError:                     # the other end of a pty is closed
            data = b''
        if not data:
            return
        send(handle, server.feed(data))


# ---- network

class Stream:
    """Cuts the bytes of one connection into frames."""
    def __init__(self, server):
        self.server = server
        self.buffer = server.partial if fault('net-shared-buffer') else bytearray()

    def feed(self, data):
        """One segment in; (bytes to send, reset the connection?)"""
        out, frames = b'', 0
        self.frames = 0
        buffer = self.buffer
        buffer += data
        while buffer:
            size = self.server.size(buffer)
            if size == 0:
                return out, True
            if size is None or len(buffer) < size:
                if fault('net-split-lost') or fault('net-tail-lost') and frames:
                    buffer.clear()
                if fault('net-split-header') and len(buffer) < self.server.header:
                    buffer.clear()
                break
            frame = bytes(buffer[:size])
            del buffer[:size]
            frames += 1
            self.frames = frames
            if fault('net-third-dropped') and frames == 3:
                continue
            out += self.server.answer(frame, self)
            if fault('net-second-dropped'):
                buffer.clear()
        return out, False


class Connection(asyncio.Protocol):
    open = []                               # the connections that have a channel
    leaked = 0

    def __init__(self, server, limit, wait):
        self.server, self.limit, self.wait = server, limit, wait
        self.timer = None

    def connection_made(self, transport):
        self.transport = transport
        transport.get_extra_info('socket').setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        limit = self.limit
        if fault('net-fifth-accepted'):
            limit += 1
        if fault('net-fourth-refused'):
            limit -= 1
        if len(Connection.open) + Connection.leaked >= limit:
            if fault('net-fifth-disturbs') and Connection.open:
                Connection.open[0].reset()
            self.reset()
            return
        Connection.open.append(self)
        self.stream = Stream(self.server)
        self.restart()

    def restart(self):
        if self.timer:
            self.timer.cancel()
        self.timer = asyncio.get_running_loop().call_later(self.wait, self.reset)

    def data_received(self, data):
        if self not in Connection.open:
            return
        out, over = self.stream.feed(data)
        if self.stream.frames and not fault('net-wait-not-restarted'):
            self.restart()
        if out:
            self.transport.write(out)
        if over:
            self.reset()

    def eof_received(self):
        if fault('net-fin-answered'):
            return False                    # asyncio closes: FIN
        self.reset()
        return True

    def reset(self):
        """RST: close with lingering off."""
        self.transport.get_extra_info('socket').setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack('ii', 1, 0))
        self.transport.abort()
        self.connection_lost(None)

    def connection_lost(self, error):
        if self.timer:
            self.timer.cancel()
        if self in Connection.open:
            Connection.open.remove(self)
            if fault('net-slot-leak') and self.stream.buffer:
                Connection.leaked += 1


class Datagrams(asyncio.DatagramProtocol):
    def __init__(self, server):
        self.server = server

    def connection_made(self, transport):
        self.transport = transport

    def datagram_received(self, data, address):
        reply = self.server.datagram(data)
        if reply:
            self.transport.sendto(reply, address)


async def serve_network(server, options):
    host, port = options.listen.rsplit(':', 1)
    loop = asyncio.get_running_loop()
    listener = await loop.create_server(lambda: Connection(server, options.connections, options.wait), host, int(port),
                                        reuse_address=True)
    if options.udp:
        udp_host, udp_port = options.udp.rsplit(':', 1)
        await loop.create_datagram_endpoint(lambda: Datagrams(server), local_addr=(udp_host, int(udp_port)))
    print('listening on %s:%d' % listener.sockets[0].getsockname()[:2], flush=True)
    await listener.serve_forever()


# ---- start

def make(protocol, memory, options=None):
    """The server of a protocol; the fault must be set before."""
    station = options.station if options else 1
    bases = options.bases if options else BASES
    if protocol == 'xgt-cnet':
        z = AREAS if options and options.cnet_z else None
        return CnetServer(memory, station, z)
    if protocol == 'ls-bus':                # an inverter: it has words of its own
        return LsBusServer(station, bool(options) and options.write_order == 'count_first')
    if protocol in SERIAL:
        return SERIAL[protocol](memory, station, bases)
    if protocol == 'modbus-tcp':
        return TcpServer(memory, bases)
    return FenetServer(memory, options.position if options else 1, options.header_check if options else 'ignore')


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--protocol', choices=[*SERIAL, *NETWORK])
    parser.add_argument('--tty', help='terminal of a serial protocol')
    parser.add_argument('--station', type=int, default=1)
    parser.add_argument('--write-order', choices=['address_first', 'count_first'], default='address_first',
                        help='of LS Bus')
    parser.add_argument('--control', action='store_true', help='LS Bus: set words by lines of JSON on standard input')
    parser.add_argument('--gap-ms', type=float, help='gap that ends a frame (serial, default 20; ASCII 1000)')
    parser.add_argument('--listen', metavar='HOST:PORT', help='network protocols; port 0 is shown on standard output')
    parser.add_argument('--udp', metavar='HOST:PORT', help='xgt-fenet over UDP too')
    parser.add_argument('--connections', type=int, default=4)
    parser.add_argument('--wait', type=float, default=100, help='reception waiting time in seconds')
    parser.add_argument('--position', type=int, default=1, help='FEnet: base * 16 + slot')
    parser.add_argument('--header-check', choices=['ignore', 'zero_or_valid', 'strict'], default='ignore')
    parser.add_argument('--cnet-z', action='store_true', help='serve Z over Cnet too (only 001 lists Z)')
    parser.add_argument('--bases', default='P0,M0,P0,M0', help='Modbus: bit read, bit write, word read, word write')
    parser.add_argument('--preset', metavar='P1=1234,...', help='words of memory at the start, in hex')
    parser.add_argument('--fault', metavar='NAME')
    parser.add_argument('--list-faults', action='store_true')
    options = parser.parse_args()
    if options.list_faults:
        for name, (protocols, text) in faults.FAULTS.items():
            print(name, ','.join(protocols), text, sep='\t')
        return
    if options.control and options.protocol != 'ls-bus':
        parser.error('--control is for ls-bus')
    if not options.protocol:
        parser.error('--protocol is needed')
    if options.fault:
        if options.protocol not in faults.FAULTS.get(options.fault, ((),))[0]:
            parser.error('no fault %s of %s' % (options.fault, options.protocol))
        faults.set_fault(options.fault)
    options.bases = dict(zip(BASES, options.bases.split(',')))
    memory = Memory()
    for item in (options.preset or '').split(','):
        name, _, value = item.partition('=')
        if name:
            memory.data[name[0]][2 * int(name[1:]):2 * int(name[1:]) + 2] = int(value, 16).to_bytes(2, 'little')
    server = make(options.protocol, memory, options)
    try:
        if options.protocol in SERIAL:
            if not options.tty:
                parser.error('--tty is needed')
            if options.gap_ms is not None:
                server.gap_seconds = options.gap_ms / 1000
            handle = open_raw(options.tty)
            if not options.control:         # there standard output belongs to the answers
                print('serving %s' % options.tty, flush=True)
            serve_serial(server, handle, options.control)
        elif not options.listen:
            parser.error('--listen is needed')
        else:
            asyncio.run(serve_network(server, options))
    except KeyboardInterrupt:
        sys.exit(0)


if __name__ == '__main__':
    main()
