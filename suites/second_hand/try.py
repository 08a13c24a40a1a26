#!/usr/bin/env python3
"""Checks of the second-hand device: printed examples as literal bytes, then for each fault a sequence
whose answers differ from the healthy device's.  `try.py` runs all in memory and a part over ptys and sockets;
`try.py --show` prints what differs; `try.py --accept` writes expected.txt from the present answers."""
import os
import sys

import device
import faults
from memory import Memory
from modbus import crc16

HERE = os.path.dirname(os.path.abspath(__file__))
C, F, R, A, T = faults.C, faults.F, faults.R, faults.A, faults.T


# ---- building requests

def cnet(text):
    """'01rSS0106%MW100' with ENQ, EOT and, if the command is lower case, BCC."""
    frame = b'\5' + text.encode('latin-1') + b'\4'
    return frame + (b'%02X' % (sum(frame) & 255) if text[2:3].islower() else b'')


def rtu(pdu, station=1):
    return (lambda f: f + crc16(f))(bytes([station]) + pdu)


def asc(pdu, station=1):
    frame = bytes([station]) + pdu
    return b':' + (frame + bytes([-sum(frame) & 255])).hex().upper().encode() + b'\r\n'


def mbap(pdu, tid=0x0102, unit=1, protocol=0, length=None):
    return b''.join(v.to_bytes(2, 'big') for v in (tid, protocol, len(pdu) + 1 if length is None else length)) \
        + bytes([unit]) + pdu


def le(value):
    return value.to_bytes(2, 'little')


def fe(body, invoke=0x0102, company=b'LSIS-XGT\0\0', source=0x33, check=None, length=None):
    head = company + b'\0\0\xa0' + bytes([source]) + le(invoke) + le(len(body) if length is None else length) + b'\0'
    return head + bytes([sum(head) & 255 if check is None else check]) + body


KIND = {'X': 0, 'B': 1, 'W': 2, 'D': 3, 'L': 4}


def names(items):
    return b''.join(le(len(n)) + n.encode('latin-1') for n in items)


class Body(bytes):
    pass


def rd(*items, kind=None, count=None, reserved=0):
    kind = KIND[items[0][2].upper()] if kind is None else kind
    return Body(b'\x54\0' + le(kind) + le(reserved) + le(len(items) if count is None else count) + names(items))


def wr(*pairs, kind=None, count=None, extra=0):
    items = [p[0] for p in pairs]
    kind = KIND[items[0][2].upper()] if kind is None else kind
    return Body(b'\x58\0' + le(kind) + b'\0\0' + le(len(items) if count is None else count) + names(items)
                + b''.join(le(len(bytes.fromhex(p[1])) + extra) + bytes.fromhex(p[1]) + bytes(extra) for p in pairs))


def crd(name, n):
    return Body(b'\x54\0\x14\0\0\0\1\0' + names([name]) + le(n))


def cwr(name, data):
    return Body(b'\x58\0\x14\0\0\0\1\0' + names([name]) + le(len(data)) + data)


# ---- a device in memory

class Rig:
    def __init__(self, protocol, name=None):
        faults.set_fault(name)
        self.protocol, self.count = protocol, 0
        self.server = device.make(protocol, Memory())
        self.streams = [device.Stream(self.server) for _ in range(4)] if protocol in (T, F) else None

    def step(self, step):
        """'P1=1234': preset; str or Body: a request; bytes: as they are; None: a gap; (n, step): connection n; ('r', name) ...: generic."""
        connection = 0
        if isinstance(step, tuple) and isinstance(step[0], int):
            connection, step = step
        if isinstance(step, tuple):
            step = self.generic(*step)
        if isinstance(step, str) and '=' in step:
            name, value = step.split('=')
            memory = getattr(self.server, 'memory', None) or self.server.functions.memory
            memory.write(name[0], 2 * int(name[1:]), int(value, 16).to_bytes(2, 'little'))
            return b''
        if step is None:
            return self.server.gap()
        raw = type(step) is bytes
        if not raw:
            self.count += 1
            step = self.frame(step)
        if self.streams:
            out, reset = self.streams[connection].feed(step)
            return out + (b'RESET' if reset else b'')
        out = self.server.feed(step)
        if self.protocol == R and not raw:
            out += self.server.gap()
        return out

    def frame(self, step):
        if self.protocol == C:
            return cnet(step)
        if self.protocol == F:
            return fe(step, 0x0200 + self.count)
        pdu = bytes.fromhex(step)
        return {R: rtu, A: asc, T: lambda p: mbap(p, 0x0200 + self.count)}[self.protocol](pdu)

    def generic(self, what, name, data=None):
        """One element read or written; data high byte first."""
        if self.protocol == C:
            return '01%sSS01%02X%s%s' % (what, len(name), name, data or '')
        return rd(name) if what == 'r' else wr((name, bytes.fromhex(data)[::-1].hex()))

    def run(self, steps):
        return [self.step(step) for step in steps]


def text(protocol, reply):
    if protocol == C:
        s = reply.decode('latin-1')
        for a, b in (('\x06', '<ACK>'), ('\x15', '<NAK>'), ('\x03', '<ETX>')):
            s = s.replace(a, b)
        return s or '-'
    if protocol == A:
        return reply.decode('latin-1').replace('\r\n', '$') or '-'
    return reply.hex() or '-'


# ---- printed examples

def printed():
    bad = []

    def same(label, got, want):
        if got != want:
            bad.append(label)
            print('PRINTED', label, got, want)

    rig = Rig(C)
    rig.server.station = 0x20
    rig.server.memory.write('M', 200, b'\xf3\xa9')
    same('bcc', cnet('20rSS0106%MW100'), b'\x0520rSS0106%MW100\x04A4')
    same('rSS', rig.step('20RSS0106%MW100'), b'\x0620RSS0102A9F3\x03')
    same('wSS', rig.step('20WSS0106%MW10000E2'), b'\x0620WSS\x03')
    rig.server.station = 1
    rig.step('01wSS0206%MW0201234' '06%PW0015678')
    same('rSS 2', rig.step('01RSS0206%MW02006%PW001'), b'\x0601RSS02021234025678\x03')
    rig.server.station = 10
    rig.step('0AwSB06%MW0000212345678')
    same('rSB', rig.step('0ARSB06%MW00002'), b'\x060ARSB010412345678\x03')
    rig.server.station = 1
    same('wSS FF', rig.step('01WSS0106%MW23000FF'), b'\x0601WSS\x03')
    same('wSB', rig.step('01WSB06%DW00001AA15'), b'\x0601WSB\x03')
    rig.step('01wSS0106%MW0002342')
    same('X', rig.step('01X01RSS0106%MW000'), b'\x0601X01\x03')
    same('Y', rig.step('01Y01'), b'\x0601Y010102' b'2342\x03')
    rig.server.station = 0x10
    rig.step('10wSB06%MW100' '029183AABB')
    rig.step('10X09RSB06%MW10002')
    same('Y SB', rig.step('10Y09'), b'\x0610Y09049183AABB\x03')
    same('003 monitor line', cnet('01rSS0104%MW0'), b'\x0501rSS0104%MW0\x0440')
    rig.server.station = 1
    for request, code in [('rSS1105%MW10', '0003'), ('rSS0111%MW10000000000000', '0004'), ('rSS0105%MK10', '0007'),
                          ('rSB05%MW10%4', '0011'), ('rSS0105$MW10', '0011'), ('rSS0105%MW^&', '0011'),
                          ('rSS0105MW0', '0011'), ('rSS0105%MWM', '0011'), ('wSS0105%MX1011', '0011'),
                          ('y05', '0090'), ('y10', '0190'), ('x10RSS0104%MW0', '0290'), ('rSS0105%QW10', '1132'),
                          ('wSB05%MW1040AA5512', '1232'), ('rSS0105%MW10000', '1234'), ('rSS0205%MW1005%MB10', '1332'),
                          ('wSS0105%MW10AA%5', '1432'), ('rSS0108%MWFFFFF', '7132'), ('wSS0104%FW00000', '1132'),
                          ('rSB04%MX001', '0007'), ('rSS00', '0011'), ('rSB04%MW000', '0011'), ('rSS0205%MW10', '0011'),
                          ('rSS0105%DX10', '0007'), ('rSS0106%MW00A', '7132'), ('rSS0107%UW00.0', '0011'),
                          ('rSS0100', '0004'), ('rSB06%MW00X01', '0011'), ('x01WSS0104%MW00000', '0011'),
                          ('rSS0107%MW1024', '7132'), ('rSB07%DW10239' '02', '7132')]:
        if '%UW00.0' in request or '%MW1024' in request or '%DW10239' in request:   # lengths as counted
            name = request[request.index('%'):][:len(request) - request.index('%') - (2 if 'SB' in request else 0)]
            request = request[:request.index('%') - 2] + '%02X' % len(name) + request[request.index('%'):]
        want = '\x1501%s%s\x03' % (request[:3], code)
        want += '%02X' % (sum(want.encode()) & 255)
        same('NAK ' + request, rig.step('01' + request), want.encode())
    for silent in (b'\x0501rSS0104%MW0\x0441', b'\x0502RSS0104%MW0\x04', b'\x0501rXX\x04' + b'%02X' % (sum(b'\x0501rXX\x04') & 255)):
        same('silence', rig.step(silent), b'')
    rig.step('01wSS0106%UX343' '01')
    same('U bit', rig.step('01RSS0106%UW034'), b'\x0601RSS01020008\x03')

    for protocol in (R, A, T):
        rig = Rig(protocol)
        for area, at, data in [('M', 2, b'\x90\x88\x29\x00'), ('P', 2, b'\x90\x88\x29\x00'),
                               ('M', 214, b'\x12\x13\x12\x3d\x4f\x40'), ('P', 16, b'\x0a\x00')]:
            rig.server.functions.memory.write(area, at, data)
        for ask, want in [('0100130013', '0103123105'), ('0200130013', '0203123105'), ('03006B0003', '030613123D12404F'),
                          ('0400080001', '0402000A'), ('050008FF00', '050008FF00'), ('0600080003', '0600080003'),
                          ('0F0013000A02CD01', '0F0013000A'), ('100013000204CD01000A', '1000130002'),
                          ('0300130002', '0304CD01000A'), ('0107D00000', '8103'), ('01000007D1', '8103'),
                          ('0500C4166B', '8503'), ('0700', '8701'), ('0303E80019', '8302'), ('0100010000', '8103'),
                          ('01270E0001', '010100'), ('01270F0001', '8102'), ('80', '8001')]:
            pdu = bytes.fromhex(want)
            same(protocol + ' ' + ask, rig.step(ask), frame_of(protocol, pdu, rig))
    rig = Rig(R)
    same('crc', rtu(bytes.fromhex('0300000001')), bytes.fromhex('010300000001840a'))
    rig = Rig(F)
    ask = bytes.fromhex('4c5349532d5847540000' '0000a033' '0000' '0e00' '00')
    same('fe check 3C', sum(ask) & 255, 0x3C)
    ask += b'\x4e' + bytes.fromhex('54000200' '00000100' '0400' '254d5730')
    want = bytes.fromhex('4c5349532d5847540000' '0701b011' '0000' '0e00' '01')
    want += bytes([sum(want) & 255]) + bytes.fromhex('55000200' '00000000' '0100' '0200' '0000')
    same('fe read', rig.step(ask), want)
    ask = bytes.fromhex('4c5349532d5847540000' '0000a033' '0001' '1000' '00' '3f' '54001400' '00000100' '0400' '254d4230' '0200')
    same('fe check 3F', sum(ask[:19]) & 255, 0x3F)
    want = bytes.fromhex('4c5349532d5847540000' '0701b011' '0001' '0e00' '01')
    want += bytes([sum(want) & 255]) + bytes.fromhex('55001400' '00000000' '0100' '0200' '0000')
    same('fe continuous', rig.step(ask), want)
    for body, code in [(rd('%MW0', count=0), 1), (rd(*['%MW0'] * 17), 1), (rd('%MB0', kind=2), 2), (rd('%QW0'), 3),
                       (wr(('%FW0', '0000')), 3), (rd('%MW1024'), 4), (crd('%MB0', 513), 5), (crd('%MB0', 0), 5),
                       (wr(('%MW0', '00')), 5), (rd('%MW^'), 0x11), (rd('%MW00000000000000', kind=2), 0x11),
                       (crd('%MW0', 2), 0x12), (rd('%MW0', kind=9), 0x24), (Body(rd('%MW0')[:-1]), 0x76),
                       (Body(rd('%MW0') + b'\0'), 0x76), (Body(b'\xb0' + rd('%MW0')[1:]), 0x78), (rd('%MK0', kind=2), 2)]:
        reply = rig.step(body)
        same('fe code %s' % body.hex(), (reply[20:22], reply[22:24], reply[26:28], reply[28:]),
             (bytes([body[0] + 1, 0]), body[2:4], b'\xff\xff', le(code)))
        same('fe nak size', (len(reply), reply[16:18]), (30, b'\x0a\0'))
    same('fe id', rig.step(fe(rd('%MW0'), company=b'LSIS-XGB\0\0'))[28:], b'\x75\0')
    same('fe glofa', rig.step(fe(rd('%MW0'), company=b'LGIS-GLOFA'))[:10], b'LGIS-GLOFA')
    rig.step(wr(('%MW0', '3412'), ('%DW5', '7856')))
    same('fe 2', rig.step(rd('%MW0', '%DW5'))[28:], bytes.fromhex('0200' '0200' '3412' '0200' '7856'))
    same('fe write', rig.step(cwr('%DB10239', b'\1\2\3'))[20:], bytes.fromhex('59001400' '00000000' '0100'))
    same('fe datagram', (rig.server.datagram(b'x' * 19), rig.server.datagram(fe(rd('%MW0')) + b'x')[28:]), (b'', b'\x76\0'))
    return bad


def frame_of(protocol, pdu, rig):
    return {R: rtu, A: asc}[protocol](pdu) if protocol != T else mbap(pdu, 0x0200 + rig.count)


from table import ROWS  # noqa: E402


def in_memory(show):
    """{(fault, protocol): (healthy answers, faulty answers)}"""
    found = {}
    for (protocols, name), steps in ROWS.items():
        for protocol in faults.GROUPS[protocols]:
            healthy = Rig(protocol).run(steps)
            faulty = Rig(protocol, name).run(steps)
            found[name, protocol] = [(text(protocol, h), text(protocol, f)) for h, f in zip(healthy, faulty)]
    faults.set_fault(None)
    return found


if __name__ == '__main__':
    failed = printed()
    results = in_memory('--show' in sys.argv)
    covered = set()
    lines = []
    for (name, protocol), answers in results.items():
        if protocol not in faults.FAULTS[name][0]:
            print('NOT OF PROTOCOL', name, protocol)
            failed.append(name)
        different = [(k, h, f) for k, (h, f) in enumerate(answers) if h != f]
        if not different:
            print('NO DIFFERENCE', name, protocol, answers[-1][0])
            failed.append(name)
        else:
            covered.add((name, protocol))
            k, h, f = different[0]
            lines.append('%s\t%s\tstep %d\t%s\t%s' % (name, protocol, k, h[-90:], f[-90:]))
    if '--net' in sys.argv or len(sys.argv) == 1:
        import wire
        wire_lines, wire_covered = wire.run()
        lines += wire_lines
        covered |= wire_covered
    if '--show' in sys.argv:
        print('\n'.join(lines))
    path = os.path.join(HERE, 'expected.txt')
    if '--accept' in sys.argv:
        open(path, 'w').write('\n'.join(lines) + '\n')
    elif os.path.exists(path) and len(sys.argv) == 1:
        if open(path).read().split('\n')[:-1] != lines:
            print('answers differ from expected.txt')
            failed.append('expected')
    missing = [(n, p) for n, (ps, _) in faults.FAULTS.items() for p in ps if (n, p) not in covered]
    for n, p in missing:
        print('NOT TRIED', n, p)
    print('%d faults, %d (fault, protocol) pairs tried, %d not tried, %d failures'
          % (len(faults.FAULTS), len(covered), len(missing), len(failed)))
    sys.exit(bool(failed or missing))
