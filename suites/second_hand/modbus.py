"""Modbus: the functions (Cnet EN 9, FEnet EN 5.3) and the RTU, ASCII and TCP framings."""
from faults import fault
from memory import READ_ONLY, index_of, split_name

BASES = {'bit_read': 'P0', 'bit_write': 'M0', 'word_read': 'P0', 'word_write': 'M0'}


class Refuse(Exception):
    def __init__(self, code):
        super().__init__(code)
        self.code = code


class Functions:
    """One request PDU in, one reply PDU out (None: silence)."""
    def __init__(self, memory, words_written=120, bases=BASES):
        self.memory, self.words_written = memory, words_written
        self.bases = {}
        for use, name in bases.items():          # 'P0100' as a bit base is word 10 bit 0
            area, kind, digits = split_name('%' + name[0] + ('X' if use.startswith('bit') else 'W') + name[1:], 'PMKTCLDUR')
            self.bases[use] = area, index_of(area, kind, digits)
        self.requests = self.last_size = 0
        self.after_exception = False

    def answer(self, pdu):
        function = pdu[0]
        self.requests += 1
        if fault('mb-17th-silent') and self.requests % 17 == 0:
            return None
        if fault('mb-after-exception') and self.after_exception:
            self.after_exception = False
            return None
        try:
            reply = self.serve(function, pdu[1:])
            self.after_exception = False
        except Refuse as refuse:
            if refuse.code is None:
                return None
            reply = bytes([function | 0x80, refuse.code])
            self.after_exception = True
        self.last_size = len(reply)
        return reply

    def serve(self, function, rest):
        if function not in (1, 2, 3, 4, 5, 6, 15, 16):
            if fault('mb-function-80-silent') and function >= 0x80:
                raise Refuse(None)
            raise Refuse(3 if fault('mb-unknown-code') else 1)
        if len(rest) < (5 if function > 6 else 4):
            raise Refuse(None if fault('mb-short-silent') else 3)
        if function <= 6 and len(rest) > 4 and not (fault('mb-surplus-read') and function < 5):
            raise Refuse(3)
        address, count = int.from_bytes(rest[:2], 'big'), int.from_bytes(rest[2:4], 'big')
        if function in (1, 2):
            return bytes([function]) + self.read_bits(function, address, count)
        if function in (3, 4):
            return bytes([function]) + self.read_words(function, address, count)
        if function == 5:
            if fault('mb-05-address-byte'):
                address &= 255
            if count not in (0xFF00, 0) and not (fault('mb-05-any-on')
                                                 or fault('mb-05-low-byte') and count >> 8 in (0, 255)):
                raise Refuse(3)
            value = count >> 8 == 255 if fault('mb-05-low-byte') else count != 0
            self.write_bits(address, [int(value)])
        elif function == 6:
            self.write_words(address, [rest[2:4]])
        elif function == 15:
            self.force_bits(address, count, rest[4], rest[5:])
        else:
            self.preset_words(address, count, rest[4], rest[5:])
            if fault('mb-10-echo-bytes'):
                return bytes([function]) + rest[:2] + bytes([0, rest[4]])
        return bytes([function]) + rest[:4]

    def span(self, use):
        """The number of addresses from the base on: 9999 or to the end of the area."""
        area, first = self.bases[use]
        words = self.memory.words(area)
        n = min(9999, words * (16 if use.startswith('bit') and area not in 'TC' else 1) - first)
        if fault('mb-end-9999') and use.startswith('bit') and n == 9999:
            n += 1
        if fault('mb-last-word-refused') and use.startswith('word'):
            n -= 1
        return n

    def check(self, use, address, count, limit):
        span = self.span(use)
        if fault('mb-start-only') and use.startswith('word') and limit == self.read_limit():
            outside = address >= span
        else:
            outside = address + count > span
        if fault('mb-02-first') and outside:
            raise Refuse(2)
        if count > limit:
            raise Refuse(2 if fault('mb-limit-code') else 3)
        if count == 0:
            raise Refuse(3)
        if outside:
            raise Refuse(2)

    def read_limit(self):
        if fault('mb-words-read-fewer'):
            return 119 if self.words_written == 120 else 124
        return 126 if fault('mb-words-read-more') else 125

    def read_bits(self, function, address, count):
        use = 'bit_write' if function == 1 or fault('mb-fc02-base') else 'bit_read'
        self.check(use, address, count, 1999 if fault('mb-bits-2000-refused') else
                   2008 if fault('mb-bits-2001') else 2000)
        area, first = self.bases[use]
        if fault('mb-02-unaligned') and function == 2 and count > 16:
            address &= ~7
        size = (count + 7) // 8
        out = bytearray(size)
        for k in range(size * 8 if fault('mb-read-padding') else count):
            number = first + address + k
            if number < self.memory.words(area) * 16:
                out[k // 8] |= self.memory.get_bit(area, number) << k % 8
        if fault('mb-stale-padding') and self.last_size > 100 and count % 8:
            out[-1] |= 255 << count % 8 & 255
        return bytes([size & 255]) + bytes(out)

    def read_words(self, function, address, count):
        use = 'word_write' if function == 3 else 'word_read'
        if fault('mb-count-byte'):
            count &= 255
        if fault('mb-zero-03') and function == 3 and count == 0:
            return b'\0'
        self.check(use, address, count, self.read_limit())
        area, first = self.bases[use]
        out = b''.join(self.memory.read(area, 2 * (first + address + k), 2)[::-1] for k in range(count))
        if fault('mb-04-swap') and function == 4:
            out = b''.join(out[k:k + 2][::-1] for k in range(0, len(out), 2))
        return bytes([2 * count]) + out

    def write_bits(self, address, values):
        self.check('bit_write', address, len(values), 1976)
        area, first = self.bases['bit_write']
        if area in READ_ONLY:
            raise Refuse(2)
        for k, value in enumerate(values):
            if fault('mb-0f-word-border') and (first + address + k) // 16 - (first + address) // 16 > 1:
                break
            self.memory.set_bit(area, first + address + k, value)

    def force_bits(self, address, count, size, data):
        if fault('mb-02-first') and address + count > self.span('bit_write'):
            raise Refuse(2)
        limit = 1967 if fault('mb-0f-1968-refused') else 1976 if fault('mb-0f-1969') else 1968
        if count > limit or count == 0:
            if count == 0 and fault('mb-zero-0f'):
                return
            raise Refuse(2 if fault('mb-limit-code') and count else 3)
        wanted = (count + 7) // 8
        if size != len(data) or size != wanted and not (fault('mb-0f-bytes-more') and size == wanted + 1):
            raise Refuse(3)
        if fault('mb-0f-padding'):
            count = min(8 * wanted, max(count, self.span('bit_write') - address))
        self.write_bits(address, [data[k // 8] >> k % 8 & 1 for k in range(count)])

    def write_words(self, address, values):
        area, first = self.bases['word_write']
        if fault('mb-10-partial') and len(values) > 1:
            for k, value in enumerate(values[:max(0, self.span('word_write') - address)]):
                self.memory.write(area, 2 * (first + address + k), value[::-1])
        self.check('word_write', address, len(values), 124)
        for k, value in enumerate(values):
            if not (fault('mb-10-odd-last') and k == len(values) - 1 and k and k % 2 == 0):
                self.memory.write(area, 2 * (first + address + k), value[::-1])

    def preset_words(self, address, count, size, data):
        if fault('mb-02-first') and address + count > self.span('word_write'):
            raise Refuse(2)
        limit = self.words_written + (1 if fault('mb-words-write-more') else -1 if fault('mb-words-write-fewer') else 0)
        if count > limit or count == 0:
            raise Refuse(2 if fault('mb-limit-code') and count else 3)
        if len(data) != 2 * count or size != len(data) and not fault('mb-10-bytes-ignored'):
            raise Refuse(3)
        self.write_words(address, [data[k:k + 2] for k in range(0, 2 * count, 2)])


# ---- serial framings

def crc16(data):
    crc = 0xFFFF
    for value in data:
        crc ^= value
        for _ in range(8):
            crc = crc >> 1 ^ 0xA001 if crc & 1 else crc >> 1
    return crc.to_bytes(2, 'little')


class RtuServer:
    gap_seconds = 0.020

    def __init__(self, memory, station=1, bases=BASES):
        self.functions, self.station = Functions(memory, 120, bases), station
        self.buffer = bytearray()
        self.lost = False

    @property
    def pending(self):
        return bool(self.buffer)

    def feed(self, data):
        self.buffer += data
        return b''

    def crc_right(self, frame):
        want, got = crc16(frame[:-2]), frame[-2:]
        if fault('rtu-crc-low'):
            return want[0] == got[0]
        if fault('rtu-crc-high'):
            return want[1] == got[1]
        if fault('rtu-crc-either') and want == got[::-1]:
            return True
        if fault('rtu-crc-06') and frame[1] == 6:
            return True
        return want == got

    def gap(self):
        """Silence ends the frame."""
        frame = bytes(self.buffer)
        if fault('rtu-gap-joined') and 3 < len(frame) < 256 and not self.crc_right(frame):
            return b''
        self.buffer.clear()
        if fault('rtu-tail-ignored') and len(frame) > 8 and frame[1] <= 6 and self.crc_right(frame[:8]):
            frame = frame[:8]
        if len(frame) < 4 or len(frame) > (192 if fault('rtu-buffer-192') else 256):
            return b''
        if self.lost:
            self.lost = False
            return b''
        if not self.crc_right(frame):
            self.lost = fault('rtu-crc-next-lost')
            if fault('rtu-crc-answered') and frame[0] == self.station:
                return self.pack(bytes([frame[1] | 0x80, 3]))
            return b''
        station = frame[0]
        if fault('rtu-station-31'):
            station &= 31
        if station != self.station and not (fault('rtu-broadcast') and station == 0):
            self.lost = fault('rtu-foreign-next') and station != 0
            return b''
        reply = self.functions.answer(frame[1:-2])
        return self.pack(reply) if reply else b''

    def pack(self, reply):
        frame = bytes([self.station]) + reply
        if fault('rtu-crc-exception') and reply[0] & 0x80:
            return frame + crc16(bytes([frame[0], frame[1] & 0x7F]) + frame[2:])
        return frame + crc16(frame)


class AsciiServer:
    gap_seconds = 1.0

    def __init__(self, memory, station=1, bases=BASES):
        self.functions, self.station = Functions(memory, 120, bases), station
        self.buffer = bytearray()
        self.noise = False
        if fault('asc-gap-short'):
            self.gap_seconds = 0.1

    @property
    def pending(self):
        return bool(self.buffer) or self.noise

    def feed(self, data):
        out = b''
        for value in data:
            reply = self.byte(value)
            if reply:
                out += reply
                if fault('asc-second-dropped'):
                    break
        return out

    def gap(self):
        self.noise = False
        if not fault('asc-gap-kept'):
            self.buffer.clear()
        return b''

    def byte(self, value):
        if value == 0x3A and not (fault('asc-no-restart') and self.buffer):
            if not (fault('asc-noise-kills') and self.noise):
                self.buffer[:] = b':'
            return None
        if not self.buffer:
            self.noise = fault('asc-noise-kills') and value not in b'\r\n'
            return None
        self.buffer.append(value)
        if len(self.buffer) > (255 if fault('asc-255') else 513):
            self.buffer.clear()
            return None
        if self.buffer.endswith(b'\r\n'):
            end = -2
        elif fault('asc-lf-alone') and value == 10 or fault('asc-cr-alone') and value == 13:
            end = -1
        else:
            return None
        text = bytes(self.buffer[1:end]).decode('latin-1')
        self.buffer.clear()
        return self.frame(text)

    def frame(self, text):
        if fault('asc-lower') and text != text.upper():
            return None
        if fault('asc-odd-digit') and len(text) % 2:
            text = text[:-1]
        if fault('asc-not-hex'):
            text = ''.join(c if c in '0123456789ABCDEFabcdef' else '0' for c in text)
        if len(text) % 2 or any(c not in '0123456789ABCDEFabcdef' for c in text) or len(text) < 6:
            return None
        frame = bytes.fromhex(text)
        want, got = -sum(frame[:-1]) & 255, frame[-1]
        if fault('asc-lrc-high'):
            want, got = want >> 4, got >> 4
        if want != got and not (fault('asc-lrc-05') and frame[1] == 5):
            return None
        if fault('asc-lrc-case') and text[-2:] != text[-2:].upper():
            return None
        if frame[0] != self.station and not (fault('asc-broadcast') and frame[0] == 0):
            return None
        reply = self.functions.answer(frame[1:-1])
        if not reply:
            return None
        reply = bytes([self.station]) + reply
        lrc = -sum(reply) & 255
        if fault('asc-lrc-exception') and reply[1] & 0x80:
            lrc = ~sum(reply) & 255
        text = (reply + bytes([lrc])).hex()
        return b':' + (text if fault('asc-reply-lower') else text.upper()).encode() + b'\r\n'


# ---- TCP

class TcpServer:
    """What all connections share."""
    def __init__(self, memory, bases=BASES):
        self.functions = Functions(memory, 123, bases)
        self.tid_exception = None
        self.unit_of = {}                       # connection -> last unit
        self.partial = bytearray()

    def size(self, buffer):
        """The length of the frame at the head of buffer: None = not known yet, 0 = reset the connection."""
        if len(buffer) < 6:
            return None
        length = int.from_bytes(buffer[4:6], 'big')
        if fault('tcp-protocol-reset') and buffer[2:4] != b'\0\0':
            return 0
        if fault('tcp-length-ignored'):
            if len(buffer) < 8:
                return None
            if buffer[7] in (15, 16):
                return 13 + buffer[12] if len(buffer) > 12 else None
            return 12
        if length < 2 or length > (250 if fault('tcp-length-250') else 260):
            return 6 + length if fault('tcp-length-0-kept') and length < 2 else 0
        return 6 + length

    header = 7

    def answer(self, frame, connection):
        tid, protocol, unit, pdu = frame[:2], frame[2:4], frame[6:7], frame[7:]
        if not pdu:
            return b''
        if protocol != b'\0\0' and not fault('tcp-protocol-ignored'):
            return b''
        if fault('tcp-unit-own') and unit not in (b'\0', b'\1', b'\xff'):
            return b''
        self.unit_of[connection] = unit
        reply = self.functions.answer(pdu)
        if reply is None:
            return b''
        exception = reply[0] & 0x80 and len(reply) == 2
        if fault('tcp-tid-byte'):
            tid = b'\0' + tid[1:]
        if fault('tcp-tid-after-exception'):
            self.tid_exception, tid = tid if exception else None, self.tid_exception or tid
        if fault('tcp-unit-exception') and exception:
            unit = b'\0'
        if fault('tcp-unit-fixed'):
            unit = b'\1'
        if fault('tcp-unit-last-connection'):
            unit = next((u for c, u in self.unit_of.items() if c != connection and u != unit), unit)
        length = 4 if fault('tcp-length-exception') and exception else len(reply) + 1
        return tid + protocol + length.to_bytes(2, 'big') + unit + reply
