#!/usr/bin/env python3
"""A second-hand P2P client of an XBC-H: asks over a serial line what the lines of --stimulus say, healthy or with one single fault."""
import argparse
import json
import os
import select
import sys
import termios
import time

from cnet import CnetServer
from memory import AREAS, SIZE, Memory, index_of, split_name

ENQ, EOT, ETX, ACK, NAK = 5, 4, 3, 6, 0x15
CLOCKS = {'F90': 0.020, 'F92': 0.200, 'F93': 1.000, '_T20MS': 0.020, '_T200MS': 0.200, '_T1S': 1.000}
KINDS = {'bit': 'X', 'byte': 'B', 'word': 'W', 'dword': 'D', 'lword': 'L'}
FOLLOWS = ['clock', 'memory', 'busy', 'mode', 'link', 'power_cycle', 'channel', 'time_out', 'delay', 'character_time', 'line', 'names']
HEX = '0123456789ABCDEFabcdef'
# Appendix 3.3 of Cnet EN
NO_HEAD, NO_TAIL, WRONG_CHECK, WRONG_STATION, WRONG_DRIVER, TIME_OUT, LENGTH, NOT_HEX, RANGE, REFUSED = 1, 2, 3, 4, 5, 10, 11, 13, 14, 15

# name | C: XGT client, R: Modbus RTU client | one sentence
TABLE = '''
station-decimal | C | the station goes out in decimal digits
station-of-first | CR | all blocks of a case ask the station of the first block in the list
name-cut | C | names of more than 7 characters are cut (length field, too)
name-bit-flat | C | a bit goes out as decimal index of all bits of the area
name-padded | C | names go out as they were entered, with their leading zeros
bcc-byte-loop | C | the loop of the BCC counts in a byte: of frames above 255 bytes only the first (length - 256) are added
bcc-sent-lower | C | the BCC of a request has its letters in lower case
fourth-lost | C | the fourth variable of a single block is not asked
variables-sorted | C | the variables of a single block are asked in the order of their addresses
sb-count-decimal | C | the number of data goes out in decimal
sb-count-bytes | C | the number of data counts bytes, whatever the type
sb-61-lost | C | a run of more than 60 elements asks for 60
write-dword-order | C | a DWord of wSS goes out low word first
write-first-only | C | wSS gives each variable the value of the first one
bit-sent-ff | C | a bit that is on is written as FF
tx-256 | C | a request longer than 256 bytes is not sent
tx-250 | R | a request longer than 250 bytes is cut there
rx-240 | CR | replies of more than 240 bytes are lost
rx-half | CR | replies of more than 128 bytes are lost
count-signed | R | a byte count of 128 and more is taken for negative: such a reply has a wrong length
values-once | CR | the values of a write are taken the first time that its block fires, and never again
values-early | CR | the values of a write are taken when the flag rises, not when the frame goes out
save-delayed | CR | what a reply brings is saved when the next reply of that block comes
save-first-only | C | of a single block only the first variable is saved
save-dword-order | C | a DWord is saved with its words exchanged
save-odd-byte | C | a byte for an odd address is saved at the even one
save-bit-word | CR | saving a bit clears the other bits of its word
save-odd-last | R | of an odd number of words above one the last is not saved
save-bits-byte | R | a run of bits is saved in whole bytes: the padding, too
save-bits-aligned | R | a run of bits is saved from the byte border below its first bit
save-swap-04 | R | words of function 04 are saved low byte first
save-one-more | CR | a run of words is saved with a word more, 0000
save-last-refused | CR | the last word of an area cannot be saved to: 0E
check-ignored | CR | no check is compared
check-first | CR | only the first digit (byte) of the check is compared
check-second | CR | only the second digit (byte) of the check is compared
check-write | CR | the check of the answer to a write is not compared
check-refusal | CR | the check of a refusal is not compared
check-saved | CR | a reply with a wrong check is an error, and saves its values
bcc-case | C | a BCC in the reply is taken as wrong where it has letters
saved-partly | C | a reply that is refused at a later value has saved the earlier ones
refusal-normal | CR | a refusal ends the block as normal
refusal-again | CR | a request that is refused is sent again at once
refusal-stops | CR | a block whose request was refused is not asked again
time-out-again | CR | after a time-out the request is sent once more
error-again | CR | after a reply with a wrong check the request is sent again
time-outs-drop | CR | after three time-outs of a station nothing more is asked of it
reply-station | CR | the station of a reply is not compared
reply-station-low | CR | only the second digit (the low five bits) of the station of a reply is compared
reply-command | CR | the command (function) of a reply is not compared
reply-type | C | the type (SS, SB) of a reply is not compared
reply-type-case | C | a reply with its type in lower case is taken for another command
reply-count | C | the block count of a reply is not looked at
reply-size | CR | the byte count of a reply is not looked at
reply-surplus | CR | surplus behind the values is not looked at
reply-fewer | CR | a reply with fewer values is taken, the rest becomes 0
reply-not-hex | C | what is no hex digit counts as 0
reply-write-data | C | the ACK of a write may have content
reply-echo | R | the address and count that the reply to 0F and 10 repeats are not compared
reply-echo-05 | R | the value that the reply to 05 and 06 repeats is not compared
refusal-length | CR | the length of a refusal is not looked at
time-out-short | CR | the time-out is n x 100 ms instead of (n + 1) x 100 ms
time-out-long | CR | the time-out is (n + 2) x 100 ms
time-out-default | CR | the time-out is 200 ms whatever is set
time-out-first | CR | the time-out is that of the first case
time-out-edge | CR | the time-out counts from the rise of the flag
time-out-bytes | CR | each byte that comes restarts the time-out
time-out-never | CR | without an answer the client waits until the case is over
not-flushed | CR | what came before the request is taken for its answer
split-lost | CR | what is not there at the first look is lost: a reply in two pieces is none
split-next | CR | the first piece of a reply lets the next block ask
gap-short | CR | a pause of 2 ms ends a frame
gap-never | CR | no pause ends a frame: half a frame waits for the time-out
gap-set | CR | the inter-character time that is set is ignored
next-early | CR | a block that is due is asked though the answer to the one before is still out
order-reversed | CR | blocks that fire together are asked from the highest number down
order-lowest | CR | what fires meanwhile does not wait for the next round: the lowest number goes first
order-fired | CR | blocks wait in a queue as they fired, without rounds or numbers
edge-kept | CR | an edge of the block that is under way is kept and asked afterwards
edge-lost | CR | an edge of another block while the line is busy is lost
edge-level | CR | a block whose flag is still on at its end is asked again
edge-both | CR | a flag that falls fires, too
clock-late | CR | the next period of a clock begins when its request goes out, 4 ms late
clock-slow | CR | clocks are slow by a tenth
clock-answer | CR | the next period of a clock begins at the end of the service
clock-catches-up | CR | edges of a clock that were missed are made up for
clock-at-once | CR | the first edge of a clock comes at once
clock-20 | CR | F90 has 40 ms
stop-ignored | CR | blocks ask in STOP
stop-keeps | CR | what waits or is under way at STOP goes on
run-fires | CR | a flag that is on at RUN fires
link-ignored | CR | blocks ask with the link disabled
link-keeps | CR | what waits or is under way when the link is disabled goes on
link-fires | CR | a flag that is on when the link is enabled fires
power-keeps | CR | what waits or is under way goes on behind a power-off
power-clock | CR | a clock keeps its phase over a power-off
over-ignored | CR | what waits for the line when a case is over is asked in the next one
channel-ignored | CR | blocks of the other channel are asked here
delay-ignored | CR | there is no delay time
delay-232 | CR | the delay time holds on RS-232C, too
delay-edge | CR | the delay time counts from the rise of the flag
head-first | C | a reply must begin with its header, noise before it makes the reply lost
noise-ends | C | bytes without a header end the wait
echo-ends | CR | the echo of a request ends the wait as a wrong reply
echo-normal | CR | the echo of a request is taken for its answer, normal
flags-both | CR | NDR stays on behind an error, ERR behind a normal end
status-stays | CR | STATUS stays behind a normal end
count-word | CR | counts have 16 bits
count-errors | CR | errors count as normal ends, too
status-time-out | CR | STATUS of a time-out is 5
request-17 | CR | every 17th request is not sent
skip-after-error | CR | the block behind one that ended with an error is passed over
crc-exception | R | an exception must have the CRC of the function without 80
crc-ends | R | a right CRC ends the frame, what follows is no part of it
address-decimal | R | a Modbus address is read as decimal number
address-byte | R | the high byte of the address is lost
single-1 | R | a continuous write of one element goes out as 05 or 06
bytes-plus | R | function 0F sends (n / 8) + 1 bytes, one too many for multiples of 8
padding-sent | R | the padding of function 0F holds the bits that follow in memory
bits-2000 | R | a run of more than 1992 bits is asked with 1992
words-120 | R | a run of 120 words is asked with 119
function-02 | R | 0x1.... is asked by function 01
function-04 | R | 0x3.... is asked by function 03
write-swap-10 | R | function 10 sends the low byte of each word first
'''
GROUPS = {'C': ('xgt-cnet',), 'R': ('modbus-rtu',), 'CR': ('xgt-cnet', 'modbus-rtu')}
FAULTS = {}
for _line in TABLE.strip().splitlines():
    _name, _group, _text = (part.strip() for part in _line.split('|'))
    assert _name not in FAULTS, _name
    FAULTS[_name] = (GROUPS[_group], _text)

active = None


def fault(name):
    assert name in FAULTS, name
    return active == name


# ---- memory

class Device(Memory):
    """Values by address, as the lines of --stimulus spell them."""
    def place_of(self, address):
        area, kind, digits = split_name(address, AREAS)
        return area, kind, index_of(area, kind, digits)

    def load(self, address, digits):
        area, kind, index = self.place_of(address)
        step = 2 * SIZE[kind]
        for n in range(0, len(digits), step):
            self.put(area, kind, index + n // step, bytes.fromhex(digits[n:n + step])[::-1])

    def take(self, address, count=1):
        """Elements, the most significant byte of each first."""
        area, kind, index = self.place_of(address)
        return [bytes(self.get(area, kind, index + n))[::-1] for n in range(count)]

    def room(self, address):
        area, kind, index = self.place_of(address)
        size = 16 if area in 'TC' and kind == 'X' else SIZE[kind]
        elements = self.words(area) * 16 if kind == 'X' else self.words(area) * 2 // size
        return elements - index

    def save(self, address, elements):
        area, kind, index = self.place_of(address)
        for n, value in enumerate(elements):
            value = bytes(value)[::-1]
            if fault('save-dword-order') and kind == 'D':
                value = value[2:] + value[:2]
            at = index + n
            if fault('save-odd-byte') and kind == 'B':
                at &= ~1
            if fault('save-bit-word') and kind == 'X' and area not in 'TC':
                self.write(area, at // 16 * 2, b'\0\0')
            self.put(area, kind, at, value)

    def bit(self, address):
        return self.take(address)[0] != b'\0'


def unpadded(address):
    """'%MW020' -> '%MW20'"""
    if not address.startswith('%') or '.' in address:
        return address
    head, digits = address[:3], address[3:]
    return head + (digits.lstrip('0') or '0')


class Done(Exception):
    """The service has ended: status 0 and what to save, or an error."""
    def __init__(self, status, values=None):
        super().__init__(status)
        self.status, self.values = status, values


# ---- XGT client (Cnet EN chapter 7)

class Cnet:
    def __init__(self):
        self.request, self.block = b'', None
        self.clear()

    def clear(self):
        self.noise, self.buffer, self.tail, self.last = bytearray(), bytearray(), 0, 0.0

    # -- request
    def name(self, address):
        if not fault('name-padded'):
            address = unpadded(address)
        if fault('name-bit-flat') and address[2] == 'X' and address[1] not in 'TC':
            area, kind, digits = split_name(address, AREAS)
            address = address[:3] + str(index_of(area, kind, digits))
        if fault('name-cut'):
            address = address[:7]
        return '%02X%s' % (len(address), address)

    def value(self, kind, element, single):
        if fault('bit-sent-ff') and kind == 'X' and element[0]:
            return 'FF'
        if fault('write-dword-order') and kind == 'D' and single:
            element = element[2:] + element[:2]
        return element.hex().upper()

    def make(self, block, station, values):
        """Values: for each variable the list of its elements."""
        self.block = block
        kind = KINDS[block['type']]
        reading = block['function'] == 'read'
        partner = block['read'] if reading else block['save']
        text = '%02d' % station if fault('station-decimal') else '%02X' % station
        if block['command'] == 'single':
            pairs = list(zip(partner, values or partner))
            if fault('fourth-lost'):
                pairs = pairs[:3]
            if fault('variables-sorted'):
                pairs.sort(key=lambda pair: pair[0])
            text += ('r' if reading else 'w') + 'SS%02X' % len(pairs)
            for address, elements in pairs:
                text += self.name(address)
                if not reading:
                    text += self.value(kind, values[0][0] if fault('write-first-only') else elements[0], True)
        else:
            count = block['size']
            if fault('sb-61-lost'):
                count = min(count, 60)
            sent = count * SIZE[kind] if fault('sb-count-bytes') else count
            text += ('r' if reading else 'w') + 'SB' + self.name(partner[0])
            text += '%02d' % sent if fault('sb-count-decimal') else '%02X' % sent
            if not reading:
                text += ''.join(self.value(kind, element, False) for element in values[0][:count])
        frame = bytes([ENQ]) + text.encode() + bytes([EOT])
        total = sum(frame[:len(frame) & 255] if fault('bcc-byte-loop') and len(frame) > 255 else frame) & 255
        self.request = frame + (b'%02x' if fault('bcc-sent-lower') else b'%02X') % total
        return b'' if fault('tx-256') and len(self.request) > 256 else self.request

    # -- reply
    def feed(self, data, now, gap, room):
        for value in data:
            self.byte(value, room)
        if self.buffer:
            self.last = now
        if data and fault('split-lost'):
            self.clear()

    def byte(self, value, room):
        if value in (ACK, NAK) and not self.tail:
            if fault('head-first') and self.noise:
                self.noise.append(value)
                return
            self.buffer = bytearray([value])
            return
        if not self.buffer:
            self.noise.append(value)
            if fault('echo-ends') and bytes(self.noise) == self.request:
                raise Done(WRONG_DRIVER)
            if fault('echo-normal') and bytes(self.noise) == self.request:
                raise Done(0)
            if fault('noise-ends') and self.request[:len(self.noise)] != self.noise:
                raise Done(NO_HEAD)
            return
        self.buffer.append(value)
        if not self.tail and value == ETX:
            self.tail = len(self.buffer)
            if self.buffer[3:4].isupper():
                self.end(room)
        elif self.tail and len(self.buffer) == self.tail + 2:
            self.end(room)

    def gap_at(self, gap):
        return self.last + gap if self.buffer else None

    def gap(self, room):
        raise Done(WRONG_CHECK if self.tail else NO_TAIL)

    def timed_out(self, room):
        noise = bytes(self.noise).replace(self.request, b'', 1)
        raise Done(NO_HEAD if noise and not self.buffer else TIME_OUT)

    def check_right(self, frame):
        want, got = b'%02X' % (sum(frame[:-2]) & 255), bytes(frame[-2:])
        if fault('check-first'):
            return got[:1].upper() == want[:1]
        if fault('check-second'):
            return got[1:].upper() == want[1:]
        if fault('check-write') and self.block['function'] == 'write' and frame[0] == ACK:
            return True
        if fault('check-refusal') and frame[0] == NAK:
            return True
        if fault('bcc-case') and not want.isdigit():
            return False
        return fault('check-ignored') or got.upper() == want

    def end(self, room):
        frame, tail = bytes(self.buffer), self.tail
        self.buffer, self.tail = bytearray(), 0
        if fault('rx-240') and len(frame) > 240 or fault('rx-half') and len(frame) > 128:
            return
        if len(frame) == tail:
            raise Done(WRONG_DRIVER)                    # upper case: no check
        try:
            self.body(frame[0], frame[1:tail - 1].decode('latin-1'), room)
        except Done as done:
            if not self.check_right(frame):
                raise Done(WRONG_CHECK, done.values if fault('check-saved') else None) from None
            raise

    def body(self, head, text, room):
        asked = self.request[1:6].decode()
        station, command, kind, text = text[:2], text[2:3], text[3:5], text[5:]
        if fault('reply-station-low'):
            station_right = station[1:] == asked[1:2]
        else:
            station_right = fault('reply-station') or station.upper() == asked[:2].upper()
        if not station_right:
            raise Done(WRONG_STATION)
        if command != asked[2] and not fault('reply-command'):
            raise Done(WRONG_DRIVER)
        if not fault('reply-type') and (kind if fault('reply-type-case') else kind.upper()) != asked[3:]:
            raise Done(WRONG_DRIVER)
        if head == NAK:
            if len(text) != 4 and not fault('refusal-length'):
                raise Done(LENGTH)
            raise Done(REFUSED)
        if self.block['function'] == 'write':
            raise Done(LENGTH if text and not fault('reply-write-data') else 0)
        self.values(text, room)

    def values(self, text, room):
        single = self.block['command'] == 'single'
        size = SIZE[KINDS[self.block['type']]]
        blocks = len(self.block['read']) if single else 1
        due = size if single else size * self.block['size']
        at, out, got_hex = 2, [], True

        def number(field):
            if fault('reply-not-hex'):
                field = ''.join(c if c in HEX else '0' for c in field)
            if len(field) < 2:
                raise Done(LENGTH)
            if any(c not in HEX for c in field):
                raise Done(NOT_HEX)
            return int(field, 16)

        count = blocks if fault('reply-count') else number(text[:2])
        for n in range(count):
            n_bytes = number(text[at:at + 2])
            if fault('reply-size'):
                n_bytes = due
            digits = text[at + 2:at + 2 + 2 * n_bytes]
            at += 2 + 2 * n_bytes
            if fault('reply-not-hex'):
                digits = ''.join(c if c in HEX else '0' for c in digits)
            if len(digits) < 2 * n_bytes:
                if fault('reply-fewer') and not single:
                    digits = digits.ljust(2 * due, '0')
                else:
                    raise Done(LENGTH, [[d] for d in out] if fault('saved-partly') else None)
            if any(c not in HEX for c in digits):
                got_hex = False
                if fault('saved-partly'):
                    raise Done(NOT_HEX, [[d] for d in out])
                digits = ''
            out.append(bytes.fromhex(digits))
        if at < len(text) and not fault('reply-surplus'):
            raise Done(LENGTH)
        if not got_hex:
            raise Done(NOT_HEX)
        for n, data in enumerate(out):
            if len(data) != due:
                if fault('reply-fewer') and len(data) < due:
                    out[n] = data.ljust(due, b'\0')
                    continue
                if fault('reply-surplus') and len(data) > due:
                    out[n] = data[:due]
                    continue
                over = n < blocks and len(data) > due and -(-len(data) // size) > room(self.block['save'][n])
                raise Done(RANGE if over else LENGTH)
        if len(out) < blocks and fault('reply-fewer'):
            out += [bytes(due)] * (blocks - len(out))
        if len(out) > blocks and fault('reply-surplus'):
            del out[blocks:]
        if len(out) != blocks:
            raise Done(LENGTH)
        raise Done(0, [[data[i:i + size] for i in range(0, len(data), size)] for data in out])


# ---- Modbus RTU client (Cnet EN chapter 9)

def crc(data):
    value = 0xFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ (0xA001 if value & 1 else 0)
    return value.to_bytes(2, 'little')


class Rtu:
    end_gap = 0.004                     # behind a frame that is whole

    def __init__(self):
        self.request, self.block = b'', None
        self.clear()

    def clear(self):
        self.buffer, self.last, self.set_gap = bytearray(), 0.0, None

    # -- request
    def make(self, block, station, values, following=b''):
        self.block = block
        reading, single = block['function'] == 'read', block['command'] == 'single'
        address = (block['read'] if reading else block['save'])[0]
        table, number = int(address[2]), int(address[3:], 10 if fault('address-decimal') else 16)
        if fault('address-byte'):
            number &= 255
        bits = table in (0, 1)
        count = 1 if single else block['size']
        if fault('bits-2000') and bits:
            count = min(count, 1992)
        if fault('words-120') and not bits and count == 120:
            count = 119
        if fault('single-1') and count == 1:
            single = True
        if reading:
            function = {0: 1, 1: 2, 3: 4, 4: 3}[table]
            if fault('function-02') and function == 2:
                function = 1
            if fault('function-04') and function == 4:
                function = 3
            body = count.to_bytes(2, 'big')
        elif bits:
            elements = values[0][:count]
            function = 5 if single else 15
            if single:
                body = b'\xff\0' if elements[0][0] else b'\0\0'
            else:
                packed = sum(element[0] << n for n, element in enumerate(elements))
                n_bytes = count // 8 + 1 if fault('bytes-plus') else (count + 7) // 8
                if fault('padding-sent') and count % 8:
                    packed |= (255 << count) & (1 << 8 * n_bytes) - 1
                body = count.to_bytes(2, 'big') + bytes([n_bytes & 255]) + packed.to_bytes(n_bytes, 'little')
        else:
            elements = values[0][:count]
            function = 6 if single else 16
            data = b''.join(element[::-1] if fault('write-swap-10') and not single else element for element in elements)
            body = data if single else count.to_bytes(2, 'big') + bytes([len(data) & 255]) + data
        self.count, self.bits = count, bits
        frame = bytes([station, function]) + number.to_bytes(2, 'big') + body
        self.request = frame + crc(frame)
        if fault('tx-250'):
            self.request = self.request[:250]
        return self.request

    # -- reply
    def feed(self, data, now, gap, room):
        if not data:
            return
        self.buffer += data
        self.last = now
        if fault('split-lost') and not self.whole():
            self.clear()
        if fault('crc-ends'):
            for n in range(5, len(self.buffer)):
                if crc(self.buffer[:n - 2]) == self.buffer[n - 2:n]:
                    del self.buffer[n:]
                    self.gap(room)
        request = self.request
        if request[1] not in (5, 6) and len(self.buffer) >= len(request) and self.buffer.startswith(request):
            if fault('echo-ends'):
                raise Done(WRONG_DRIVER)
            if fault('echo-normal'):
                raise Done(0)
            del self.buffer[:len(request)]

    def whole(self):
        return len(self.buffer) >= 4 and crc(self.buffer[:-2]) == self.buffer[-2:]

    def gap_at(self, gap):
        if not self.buffer:
            return None
        return self.last + (self.end_gap if self.whole() and gap <= 0.020 else gap)

    def timed_out(self, room):
        if self.whole():
            self.gap(room)
        raise Done(TIME_OUT)

    def check_right(self, frame):
        want, got = crc(frame[:-2]), frame[-2:]
        if fault('crc-exception') and frame[1] & 0x80:
            want = crc(bytes([frame[0], frame[1] & 0x7f]) + frame[2:-2])
        if fault('check-first'):
            return got[:1] == want[:1]
        if fault('check-second'):
            return got[1:] == want[1:]
        if fault('check-write') and self.block['function'] == 'write' and frame[1] < 0x80:
            return True
        if fault('check-refusal') and frame[1] & 0x80:
            return True
        return fault('check-ignored') or got == want

    def gap(self, room):
        frame = bytes(self.buffer)
        self.buffer = bytearray()
        if fault('rx-240') and len(frame) > 240 or fault('rx-half') and len(frame) > 128:
            return
        if len(frame) < 4:
            raise Done(LENGTH)
        try:
            self.body(frame)
        except Done as done:
            if not self.check_right(frame):
                raise Done(WRONG_CHECK, done.values if fault('check-saved') else None) from None
            raise

    def body(self, frame):
        asked, function, data = self.request, frame[1], frame[2:-2]
        mask = 31 if fault('reply-station-low') else 255
        if (frame[0] ^ asked[0]) & mask and not fault('reply-station'):
            raise Done(WRONG_STATION)
        if function == asked[1] | 0x80:
            raise Done(LENGTH if len(data) != 1 and not fault('refusal-length') else REFUSED)
        if function != asked[1] and not fault('reply-command'):
            raise Done(WRONG_DRIVER)
        if self.block['function'] == 'write':
            if len(data) != 4 and not (fault('reply-surplus') and len(data) > 4):
                raise Done(LENGTH)
            if fault('reply-echo') and asked[1] > 6:
                raise Done(0)
            repeated = 2 if fault('reply-echo-05') and asked[1] < 7 else 4
            raise Done(0 if data[:repeated] == asked[2:2 + repeated] else WRONG_DRIVER)
        due = (self.count + 7) // 8 if self.bits else 2 * self.count
        size, data = data[:1], data[1:]
        if fault('count-signed') and size and size[0] > 127:
            raise Done(LENGTH)
        if fault('reply-surplus'):
            data = data[:due]
        if fault('reply-fewer') and size and size[0] == len(data) < due:
            data, size = data.ljust(due, b'\0'), bytes([due])
        if fault('reply-size'):
            size = bytes([due])
        if size != bytes([due]) or len(data) != due:
            raise Done(LENGTH)
        if self.bits:
            n = 8 * due if fault('save-bits-byte') else self.count
            raise Done(0, [[bytes([data[k // 8] >> k % 8 & 1]) for k in range(n)]])
        swap = -1 if fault('save-swap-04') and asked[1] == 4 else 1
        raise Done(0, [[data[k:k + 2][::swap] for k in range(0, due, 2)]])


# ---- the P2P service

class Client:
    def __init__(self, driver, handle, station):
        self.driver, self.handle, self.own = driver, handle, station
        self.device = Device()
        self.setting = {'channel': 1, 'link': True, 'mode': 'run', 'time_out_ms': 200, 'delay_ms': 0, 'inter_character_ms': 0,
                        'rs485': False, 'blocks': []}
        self.first_time_out = None
        self.line = 0.0                         # when the line was last in use
        self.sent = 0
        self.reset(time.monotonic())

    def reset(self, now):
        self.blocks, self.clocks, self.taken, self.dead, self.silent = {}, {}, {}, set(), {}
        self.held, self.stale = False, b''
        self.delayed = {}
        self.power_on(now)

    def power_on(self, now, clocks=True):
        self.give_up()
        if clocks:
            self.zero = {flag: now for flag in CLOCKS}
            self.edges = dict.fromkeys(CLOCKS, 0)

    def give_up(self):
        self.round, self.pending, self.under_way, self.again = [], [], None, False
        self.driver.clear()

    @property
    def running(self):
        return (self.setting['mode'] == 'run' or fault('stop-ignored')) and (self.setting['link'] or fault('link-ignored'))

    # -- lines
    def told(self, line, now):
        if 'hello' in line:
            print(json.dumps({'follows': FOLLOWS, 'time_out_ms': 200}), flush=True)
        elif 'begin' in line:
            kept = self.round + self.pending if fault('over-ignored') else []
            self.setting = dict(self.setting, **line['begin'])
            self.device = Device()
            self.reset(now)
            self.pending = kept
            for block in self.setting['blocks']:
                self.blocks[self.key(block)] = block
                self.show(block)
            self.load(self.setting.get('memory', {}))
            set_line(self.handle, self.setting.get('line'))
            if self.first_time_out is None:
                self.first_time_out = self.setting['time_out_ms']
        elif 'block' in line:
            self.asked(line, now)
        elif 'set' in line:
            before = self.flags()
            self.load(line['set'])
            if fault('edge-both'):
                for key in self.flags_changed(before, falling=True):
                    self.fire(key, now)
        elif 'do' in line:
            self.done_to(line['do'], now)
        elif 'over' in line:
            if not fault('over-ignored'):
                self.give_up()
            else:
                self.under_way = None
            self.clocks = {}

    def key(self, block):
        return block['parameter'], block['block']

    def load(self, values):
        for address, digits in values.items():
            self.device.load(address, digits)

    def asked(self, line, now):
        block = line['block']
        key = self.key(block)
        self.blocks[key] = block
        if 'flag' in block and block['flag'] in CLOCKS:
            if key not in self.clocks and fault('clock-at-once'):
                self.fire(key, now)
            self.clocks[key] = block['flag']
            return
        self.load(line.get('values', {}))
        self.held = not line.get('last', True)
        self.fire(key, now)

    def done_to(self, what, now):
        if what == 'power_cycle':
            if not fault('power-keeps'):
                self.power_on(now, clocks=not fault('power-clock'))
            return
        was = self.running
        if what in ('run', 'stop'):
            self.setting['mode'] = what
        elif what in ('link on', 'link off'):
            self.setting['link'] = what == 'link on'
        if was and not self.running and not fault('stop-keeps' if what == 'stop' else 'link-keeps'):
            self.give_up()
        if self.running and not was and fault('run-fires' if what == 'run' else 'link-fires'):
            for key, on in self.flags().items():
                if on:
                    self.fire(key, now)

    # -- flags
    def flags(self):
        return {key: self.device.bit(block['flag']) for key, block in self.blocks.items()
                if block.get('flag', '').startswith('%')}

    def flags_changed(self, before, falling=False):
        return [key for key, on in self.flags().items() if on != before.get(key, False) and on != falling]

    def fire(self, key, now):
        block = self.blocks[key]
        if not self.running or block['function'] not in ('read', 'write') or key in self.dead:
            return
        if block.get('channel', self.setting['channel']) != self.setting['channel'] and not fault('channel-ignored'):
            return
        if self.under_way and self.under_way['key'] == key:
            self.again = fault('edge-kept')
            return
        if fault('edge-lost') and self.under_way:
            return
        if any(key == other for other, _, _ in self.round + self.pending):
            return
        self.pending.append((key, now, self.taking(block) if fault('values-early') else None))

    def tick_clocks(self, now):
        for flag in set(self.clocks.values()):
            period = CLOCKS[flag]
            if fault('clock-slow'):
                period *= 1.1
            if fault('clock-20') and flag in ('F90', '_T20MS'):
                period *= 2
            edge = int((now - self.zero[flag]) / period)
            if edge <= self.edges[flag]:
                continue
            if fault('clock-catches-up'):
                busy = [key for key in self.clocks if self.clocks[key] == flag and self.wanted(key)]
                if busy:
                    continue                    # made up for when the line is free
                self.edges[flag] += 1
            else:
                self.edges[flag] = edge
            if fault('clock-late'):
                self.zero[flag] = now + 0.004
                self.edges[flag] = 0
            for key in self.clocks:
                if self.clocks[key] == flag:
                    self.fire(key, now)

    def wanted(self, key):
        return self.under_way and self.under_way['key'] == key or any(key == other for other, _, _ in self.round + self.pending)

    def next_clock(self, now):
        times = []
        for flag in set(self.clocks.values()):
            period = CLOCKS[flag] * (1.1 if fault('clock-slow') else 2 if fault('clock-20') and flag in ('F90', '_T20MS') else 1)
            times.append(self.zero[flag] + (int((now - self.zero[flag]) / period) + 1) * period)
        return times

    # -- services
    def taking(self, block):
        """What a write takes from memory."""
        if block['function'] == 'read':
            return None
        count = 1 if block['command'] == 'single' else block['size']
        if fault('values-once'):
            return self.taken.setdefault(self.key(block), [self.device.take(address, count) for address in block['read']])
        return [self.device.take(address, count) for address in block['read']]

    def time_out(self):
        limit = self.setting['time_out_ms']
        if fault('time-out-short'):
            limit -= 100
        if fault('time-out-long'):
            limit += 100
        if fault('time-out-default'):
            limit = 200
        if fault('time-out-first'):
            limit = self.first_time_out
        return 1e9 if fault('time-out-never') else limit / 1000

    def delay(self):
        on = (self.setting['rs485'] or fault('delay-232')) and not fault('delay-ignored')
        return self.setting['delay_ms'] / 1000 if on else 0

    def gap(self):
        if fault('gap-short'):
            return 0.002
        if fault('gap-never'):
            return 1e9
        return max(0.020, 0 if fault('gap-set') else self.setting['inter_character_ms'] / 1000)

    def choose(self):
        """The next block of the round, or of a new one."""
        if self.held:
            return None
        if fault('order-fired') or fault('order-lowest'):
            self.round += self.pending
            self.pending = []
            if fault('order-lowest'):
                self.round.sort(key=lambda item: item[0])
        if not self.round:
            self.round, self.pending = sorted(self.pending, key=lambda item: item[0], reverse=fault('order-reversed')), []
        return self.round[0] if self.round else None

    def start(self, now):
        """Sends what is due; the time when something will be, or None."""
        while not self.under_way or fault('next-early') and not self.held and (self.round or self.pending):
            item = self.choose()
            if not item:
                return None
            key, fired, early = item
            free = (fired if fault('delay-edge') else self.line) + self.delay()
            if now < free and self.delay():
                return free
            self.round.pop(0)
            block = self.blocks[key]
            station = block['station']
            if fault('station-of-first') and self.setting['blocks']:
                station = self.setting['blocks'][0].get('station', station)
            self.driver.clear()
            frame = self.driver.make(block, station, early or self.taking(block))
            self.sent += 1
            if not (fault('request-17') and self.sent % 17 == 0):
                self.send(frame)
            now = self.line = time.monotonic()
            self.under_way = {'key': key, 'from': fired if fault('time-out-edge') else now, 'again': 0}
            stale, self.stale = self.stale, b''
            if stale and fault('not-flushed'):
                self.attempt(lambda: self.driver.feed(stale, now, self.gap(), self.device.room), now)
        return None

    def send(self, frame):
        while frame:
            frame = frame[os.write(self.handle, frame):]
        termios.tcdrain(self.handle)

    def heard(self, data, now):
        self.line = now
        if not self.under_way:
            self.stale += data
            return
        if fault('time-out-bytes'):
            self.under_way['from'] = now
        self.attempt(lambda: self.driver.feed(data, now, self.gap(), self.device.room), now)
        if fault('split-next') and self.under_way and (self.round or self.pending):
            self.under_way = None

    def attempt(self, what, now):
        try:
            what()
        except Done as done:
            self.ended(done.status, done.values, now)

    def times(self, now):
        """Lets a gap or the time-out end the service; the times when that is due."""
        if not self.under_way:
            return []
        due = self.driver.gap_at(self.gap())
        if due is not None and now >= due:
            self.attempt(lambda: self.driver.gap(self.device.room), now)
            return [now]
        limit = self.under_way['from'] + self.time_out()
        if now >= limit:
            self.attempt(lambda: self.driver.timed_out(self.device.room), now)
            return [now]
        return [limit] if due is None else [limit, due]

    def ended(self, status, values, now):
        key, again = self.under_way['key'], self.under_way['again']
        block = self.blocks[key]
        repeat = (fault('refusal-again') and status == REFUSED or fault('time-out-again') and status in (TIME_OUT, NO_HEAD)
                  or fault('error-again') and status == WRONG_CHECK)
        self.driver.clear()
        if repeat and not again:
            self.send(self.driver.request)
            self.under_way = {'key': key, 'from': time.monotonic(), 'again': 1}
            return
        self.under_way = None
        if fault('refusal-normal') and status == REFUSED:
            status = 0
        if fault('refusal-stops') and status == REFUSED:
            self.dead.add(key)
        if fault('time-outs-drop'):
            station = block['station']
            self.silent[station] = self.silent.get(station, 0) + 1 if status == TIME_OUT else 0
            if self.silent[station] >= 3:
                self.dead |= {other for other, b in self.blocks.items() if b.get('station') == station}
        if fault('skip-after-error') and status and self.round:
            self.round.pop(0)
        before = self.flags()
        if values and fault('save-delayed'):
            values, self.delayed[key] = self.delayed.get(key), values
        if values:
            status = self.save(block, values, status)
        self.result(key, status)
        for other in self.flags_changed(before):
            self.fire(other, now)
        if fault('edge-level') and not self.wanted(key) and self.flags().get(key):
            self.fire(key, now)
        if fault('clock-answer') and key in self.clocks:
            self.zero[self.clocks[key]], self.edges[self.clocks[key]] = now, 0
        if self.again:
            self.again = False
            self.fire(key, now)

    def save(self, block, values, status):
        targets = block['save']
        if fault('save-first-only'):
            targets = targets[:1]
        for address, elements in zip(targets, values):
            if fault('save-last-refused') and block['type'] == 'word' and len(elements) == self.device.room(address):
                return RANGE
            if fault('save-odd-last') and block['type'] == 'word' and len(elements) > 1 and len(elements) % 2:
                elements = elements[:-1]
            if fault('save-one-more') and block['type'] == 'word' and block['command'] == 'continuous':
                elements = elements + [b'\0\0']
            if fault('save-bits-aligned') and len(elements) > 1 and address[2] == 'X':
                address = address[:-1] + ('8' if int(address[-1], 16) > 7 else '0')
            self.device.save(address, elements[:self.device.room(address)])
        return status

    # -- L and N (Cnet EN appendix 2)
    def result(self, key, status):
        parameter, number = key
        word = 512 + 192 * (parameter - 1) + 6 * number
        old = int.from_bytes(self.device.read('L', 2 * word, 2), 'little')
        flags = 2 if status else 1
        if fault('flags-both'):
            flags |= old
        self.device.write('L', 2 * word, flags.to_bytes(2, 'little'))
        if status or not fault('status-stays'):
            shown = 5 if fault('status-time-out') and status == TIME_OUT else status
            self.device.write('L', 2 * word + 2, shown.to_bytes(2, 'little'))
        for at, counts in ((2, not status or fault('count-errors')), (4, status)):
            if counts:
                place, size = 2 * (word + at), 2 if fault('count-word') else 4
                count = int.from_bytes(self.device.read('L', place, size), 'little') + 1
                self.device.write('L', place, (count & (1 << 8 * size) - 1).to_bytes(size, 'little'))

    def show(self, block):
        """The parameters of the block, in N."""
        if block['function'] not in ('read', 'write'):
            return
        word = 1312 * (block['parameter'] - 1) + 41 * block['block']
        self.device.write('N', 2 * word, block['station'].to_bytes(2, 'little'))
        size = SIZE[KINDS[block['type']]] * (1 if block['command'] == 'single' else block['size'])
        for first, addresses in ((1, block['read']), (21, block['save'])):
            for n in range(4):
                name = unpadded(addresses[n]) if n < len(addresses) else ''
                at = 2 * (word + first + 5 * n)
                self.device.write('N', at, name.encode()[:8].ljust(8, b'\0'))
                self.device.write('N', at + 8, (size if name else 0).to_bytes(2, 'little'))


# ---- the line

def open_raw(path):
    handle = os.open(path, os.O_RDWR | os.O_NOCTTY)
    mode = termios.tcgetattr(handle)
    mode[0] = mode[1] = mode[3] = 0
    mode[2] = termios.CS8 | termios.CREAD | termios.CLOCAL
    mode[4] = mode[5] = termios.B9600
    mode[6][termios.VMIN], mode[6][termios.VTIME] = 1, 0
    termios.tcsetattr(handle, termios.TCSANOW, mode)
    return handle


def set_line(handle, text):
    """'9600-8N1'"""
    if not text:
        return
    speed, form = text.split('-')
    mode = termios.tcgetattr(handle)
    mode[4] = mode[5] = getattr(termios, 'B' + speed)
    mode[2] = termios.CREAD | termios.CLOCAL | (termios.CS7 if form[0] == '7' else termios.CS8)
    mode[2] |= {'N': 0, 'E': termios.PARENB, 'O': termios.PARENB | termios.PARODD}[form[1]]
    mode[2] |= termios.CSTOPB if form[2] == '2' else 0
    try:
        termios.tcsetattr(handle, termios.TCSANOW, mode)
    except termios.error:
        pass


def serve(client, handle, aux):
    text = b''
    server = CnetServer(client.device, 1)       # the other port of the same PLC, over which its memory is read
    while True:
        now = time.monotonic()
        client.tick_clocks(now)
        client.times(now)
        free = client.start(now)
        due = client.times(time.monotonic()) + client.next_clock(now) + ([] if free is None else [free])
        now = time.monotonic()
        ready = select.select([handle, 0] + [aux] * (aux is not None), [], [], max(0.0, min(due + [now + 60]) - now))[0]
        if handle in ready:
            try:
                data = os.read(handle, 4096)
            except OSError:                     # the other end of a pty is closed
                return
            if not data:
                return
            client.heard(data, time.monotonic())
        if aux in ready:
            server.memory = client.device
            os.write(aux, server.feed(os.read(aux, 4096)))
        if 0 in ready:
            data = os.read(0, 65536)
            if not data:
                return
            text += data
            *lines, text = text.split(b'\n')
            for line in lines:
                if line.strip():
                    client.told(json.loads(line), time.monotonic())


def main():
    global active
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--protocol', choices=['xgt-cnet', 'modbus-rtu'])
    parser.add_argument('--tty', help='terminal of the line')
    parser.add_argument('--aux', metavar='PATH', help='terminal on which the PLC is XGT server, station 1 (the --aux of the bench)')
    parser.add_argument('--station', type=int, default=0, help='of the client itself, which no frame carries')
    parser.add_argument('--fault', metavar='NAME')
    parser.add_argument('--list-faults', action='store_true')
    options = parser.parse_args()
    if options.list_faults:
        for name, (protocols, text) in FAULTS.items():
            print(name, ','.join(protocols), text, sep='\t')
        return
    if not options.protocol or not options.tty:
        parser.error('--protocol and --tty are needed')
    if options.fault:
        if options.protocol not in FAULTS.get(options.fault, ((),))[0]:
            parser.error('no fault %s of %s' % (options.fault, options.protocol))
        active = options.fault
    handle = open_raw(options.tty)
    try:
        serve(Client(Cnet() if options.protocol == 'xgt-cnet' else Rtu(), handle, options.station), handle,
              open_raw(options.aux) if options.aux else None)
    except KeyboardInterrupt:
        sys.exit(0)


if __name__ == '__main__':
    main()
