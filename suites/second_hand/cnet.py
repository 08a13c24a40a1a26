"""XGT Cnet server (000 and 003 chapter 7, appendix 3.1)."""
from faults import fault
from memory import AREAS, HEX, READ_ONLY, SIZE, Refused, index_of, split_name

ENQ, EOT, ETX, ACK, NAK = 5, 4, 3, 6, 0x15
CODES = {'percent': '0011', 'area': '1132', 'type': '0007', 'form': '0011', 'range': '7132'}


class Nak(Exception):
    def __init__(self, code):
        super().__init__(code)
        self.code = code


def is_hex(text):
    return bool(text) and all(c in HEX for c in text)


class Reader:
    """Takes the fields of a request from left to right."""
    def __init__(self, text):
        self.text, self.at = text, 0

    def take(self, n):
        if self.at + n > len(self.text):
            raise Nak('0011')
        self.at += n
        return self.text[self.at - n:self.at]

    def number(self):
        field = self.take(2)
        if not is_hex(field):
            raise Nak('0011')
        return int(field, 16)

    def end(self):
        if self.at < len(self.text):
            raise Nak('0011' if fault('cnet-surplus-code') else '1234')


class CnetServer:
    gap_seconds = 0.020

    def __init__(self, memory, station=1, areas=None):
        self.memory, self.station = memory, station
        self.areas = areas or [a for a in AREAS if a != 'Z']     # no edition of the Cnet manual lists Z
        self.buffer, self.tail = bytearray(), 0                  # tail: index behind EOT, 0 = not yet seen
        self.monitors = {}
        self.noise = False
        self.requests = self.registered = self.last_size = self.last_sb = 0
        self.last_nak = False

    @property
    def pending(self):
        return bool(self.buffer) or self.noise

    # ---- frames
    def feed(self, data):
        out = b''
        for value in data:
            reply = self.byte(value)
            if reply is not None:
                out += reply
                if fault('cnet-second-dropped'):
                    break
        return out

    def gap(self):
        out = b''
        self.noise = False
        if fault('cnet-bcc-missing') and self.tail and len(self.buffer) == self.tail:
            out = self.frame(bytes(self.buffer)) or b''
        if not fault('cnet-gap-joined'):
            self.drop()
        return out

    def drop(self):
        self.buffer, self.tail = bytearray(), 0

    def byte(self, value):
        """The reply when this byte completes a frame, else None."""
        if value == ENQ and not (fault('cnet-enq-no-restart') and self.buffer):
            if fault('cnet-noise-kills') and self.noise:
                return None
            self.buffer, self.tail = bytearray([ENQ]), 0
            return None
        if not self.buffer:
            self.noise = fault('cnet-noise-kills')
            return None
        self.buffer.append(value)
        size = len(self.buffer)
        if not self.tail:
            if value == EOT or (fault('cnet-etx-tail') and value == ETX):
                self.tail = size
            elif size > 1024:
                self.drop()
                return None
        lower = self.buffer[3:4].islower()
        if not self.tail or (lower and size < self.tail + 2):
            return None
        frame = bytes(self.buffer)
        self.drop()
        if lower and not self.bcc_right(frame):
            return None
        if fault('cnet-buffer-256') and size > 256 or fault('cnet-buffer-512') and size > 512:
            return None
        return self.frame(frame[:-2] if lower else frame)

    def bcc_right(self, frame):
        want, got = b'%02X' % (sum(frame[:-2]) & 255), frame[-2:]
        if fault('cnet-bcc-ignored-y') and frame[3:4] == b'y':
            return True
        if fault('cnet-bcc-ignored-wsb') and frame[3:6].upper() == b'WSB':
            return True
        if fault('cnet-bcc-low-digit'):
            return got[1:].upper() == want[1:]
        if fault('cnet-bcc-case'):
            return got == want
        return got.upper() == want

    def station_right(self, text):
        if fault('cnet-station-low-digit'):
            return is_hex(text[1:]) and int(text[1:], 16) == self.station & 15
        if not is_hex(text) or len(text) < 2:
            return False
        if fault('cnet-station-00') and text == '00' or fault('cnet-station-ff') and text.upper() == 'FF':
            return True
        return int(text, 16) == self.station

    def frame(self, frame):
        """A request from ENQ to EOT with a right BCC."""
        text = frame[1:-1].decode('latin-1')
        command = text[2:3]
        if not self.station_right(text[:2]) or command not in tuple('rRwWxXyY'):
            return None
        self.requests += 1
        if fault('cnet-17th-silent') and self.requests % 17 == 0:
            return None
        head = '%02X%s' % (self.station, command)
        rest = Reader(text[3:])
        code = None
        try:
            if command in 'rRwW':
                kind = rest.text[:2].upper() if rest.text[:2].isascii() else ''
                if fault('cnet-type-lower') and rest.text[:2] != kind:
                    return None
                if kind not in ('SS', 'SB'):
                    if fault('cnet-unknown-nak'):
                        head += rest.text[:2]
                        raise Nak('0011')
                    return None
                rest.at = 2
                head += kind
                body = self.read(kind, rest) if command in 'rR' else self.write(kind, rest)
            else:
                number = rest.text[:2]
                rest.at = len(number)
                head += number.upper() if is_hex(number) else number
                body = self.register(number, rest) if command in 'xX' else self.monitor(number, rest)
        except Nak as nak:
            code = nak.code
        except Refused as refused:
            code = CODES[refused.why]
            if fault('cnet-type-code') and refused.why == 'type':
                code = '1132'
        lower = command.islower()
        if code:
            if fault('cnet-mon-nak-clears') and command in 'rRwW':
                self.monitors.pop(0, None)
            if fault('cnet-nak-upper') and command == 'w':
                head, lower = head.replace('w', 'W'), False
            body = code
        elif fault('cnet-upper-y-lower') and command == 'Y':
            head = head.replace('Y', 'y')
        if fault('cnet-long-then-ack') and command in 'wW' and not code and self.last_size > 200:
            body = '00'
        out = bytes([NAK if code else ACK]) + (head + body).encode('latin-1') + bytes([ETX])
        if lower or (fault('cnet-upper-wsb-bcc') and head[2:] == 'WSB'):
            total = sum(out)
            if fault('cnet-bcc-nak-no-head') and code:
                total -= NAK
            if fault('cnet-bcc-after-nak') and self.last_nak:
                total += 1
            out += (b'%02x' if fault('cnet-bcc-reply-lower') else b'%02X') % (total & 255)
        self.last_size, self.last_nak = len(out), bool(code)
        return out

    # ---- fields
    def name(self, rest, write):
        length = rest.number()
        if length == 0 and fault('cnet-name-0-code'):
            raise Nak('0011')
        limit = 17 if fault('cnet-name-17') else 15 if fault('cnet-name-16-refused') else 16
        if length == 0 or length > limit:
            raise Nak('0004')
        area, kind, digits = split_name(rest.take(length), self.areas)
        if write and area in READ_ONLY and not (fault('mem-f-writable') and area == 'F'
                                                or fault('mem-n-writable') and area == 'N'):
            raise Nak('7132' if fault('cnet-readonly-code') else '1132')
        if area == 'D' and kind == 'X':
            raise Nak('0007')
        return area, kind, digits

    def data(self, rest, kind, half=False):
        """The data of one element, low byte first."""
        text = rest.take(2 * SIZE[kind])
        if half and fault('cnet-data-half-checked'):
            text = text[:2] + ''.join(c if c in HEX else '0' for c in text[2:])
        if not is_hex(text) or (fault('cnet-data-lower') and text != text.upper()):
            raise Nak('1432')
        value = bytes.fromhex(text)
        if kind == 'X' and value[0] > 1:
            if fault('cnet-bit-value'):
                return b'\1'
            raise Nak('1432' if fault('cnet-bit-value-code') else '0011')
        return value if fault('cnet-wss-lword-order') and kind == 'L' and not half else value[::-1]

    def blocks(self, rest, write=False, monitor=False):
        """The blocks of SS: (area, kind, index, data or None)."""
        field = rest.take(2)
        if not is_hex(field):
            raise Nak('0011')
        count = int(field, 16)
        if fault('cnet-count-decimal') and field.isdecimal():
            count = int(field)
        limit = 15 if fault('cnet-count-16-refused') and not write else \
            17 if fault('cnet-count-17-wss') and write else 16
        if count > limit:
            raise Nak('0011' if monitor and fault('cnet-x-blocks-code') else '0003')
        if count == 0 and not (fault('cnet-count-0-rss') and not write):
            raise Nak('0003' if fault('cnet-count-0-code') else '0011')
        found = []
        for k in range(count):
            area, kind, digits = self.name(rest, write)
            if found and kind != found[0][1] and not fault('cnet-mixed-write' if write else 'cnet-mixed-read'):
                raise Nak('1332')
            index = index_of(area, kind, digits)
            if not (monitor and fault('cnet-mon-unchecked')):
                self.memory.check(area, kind, index)
            data = self.data(rest, kind) if write else None
            if write and fault('cnet-wss-partial') and k + 1 < count:
                self.memory.put(area, kind, index, data)
            found.append((area, kind, index, data))
        if not (fault('cnet-surplus-rss') and not write and not monitor):
            rest.end()
        return found

    def run(self, rest, write=False, monitor=False):
        """The run of SB: (area, kind, index, count, data)."""
        area, kind, digits = self.name(rest, write)
        if kind == 'X' and not (fault('cnet-sb-bit-bytes') and not write):
            raise Nak('0007')
        index = index_of(area, kind, digits)
        count = rest.number()
        if count == 0 and not (fault('cnet-sb-0') and not write):
            raise Nak('0011')
        limit = 120 // SIZE[kind]
        if fault('cnet-sb-61') and not write and kind == 'W':
            limit = 61
        if fault('cnet-sb-bytes-60') and not write and kind == 'B':
            limit = 60
        if fault('cnet-sb-dword-60') and not write and kind == 'D':
            limit = 60
        if fault('cnet-wsb-60-refused') and write:
            limit = 119 // SIZE[kind]
        if count > limit:
            raise Nak('7132' if fault('cnet-sb-limit-code') and write else '1232')
        try:
            if not (monitor and fault('cnet-mon-unchecked')):
                self.memory.check(area, kind, index, count)
        except Refused:
            if fault('cnet-wsb-partial') and write:
                while index < self.memory.words(area) * 2 // SIZE[kind]:
                    self.memory.put(area, kind, index, self.data(rest, kind, True))
                    index += 1
            if fault('cnet-sb-end-code') and index < self.memory.words(area) * 2 // SIZE[kind]:
                raise Nak('1132') from None
            raise
        data = [self.data(rest, kind, True) for _ in range(count)] if write else None
        if not (fault('cnet-surplus-wsb') and write):
            rest.end()
        return area, kind, index, count, data

    # ---- commands
    def read(self, kind, rest):
        if kind == 'SS':
            return self.show_blocks(self.blocks(rest))
        return '01' + self.show_run(*self.run(rest)[:4])

    def show_blocks(self, blocks):
        return '%02X' % len(blocks) + ''.join(
            '%02X' % SIZE[kind] + self.memory.get(area, kind, index)[::-1].hex().upper()
            for area, kind, index, _ in blocks)

    def show_run(self, area, kind, index, count):
        parts = [self.memory.get(area, kind, index + k)[::-1] for k in range(count)]
        if fault('cnet-rsb-dword-order') and kind == 'D':
            parts = [part[2:] + part[:2] for part in parts]
        if fault('cnet-rsb-odd-tail') and kind == 'B' and count % 2:
            parts[-1] = b'\0'
        size = count if fault('cnet-rsb-dword-count') and kind == 'D' else count * SIZE[kind]
        return '%02X' % size + b''.join(parts).hex().upper()

    def write(self, kind, rest):
        if kind == 'SS':
            for k, (area, kind, index, data) in enumerate(self.blocks(rest, write=True)):
                if not (fault('cnet-wss-16th-lost') and k == 15):
                    self.memory.put(area, kind, index, data)
            return ''
        area, kind, index, count, data = self.run(rest, write=True)
        if fault('cnet-wsb-odd-start') and kind == 'B':
            index &= ~1
        for k in range(count):
            self.memory.put(area, kind, index + k, data[k])
        return ''

    def register(self, field, rest):
        if len(field) < 2 or not is_hex(field):
            raise Nak('0290')
        number = int(field, 16)
        if fault('cnet-mon-10-alias'):
            number &= 15
        if number > (14 if fault('cnet-mon-0f-refused') else 15):
            raise Nak('0290')
        if fault('cnet-mon-8-alias'):
            number &= 7
        content = rest.take(3).upper()
        try:
            if content == 'RSS':
                found = self.blocks(rest, monitor=True)
            elif content == 'RSB':
                found = self.run(rest, monitor=True)[:4]
                self.last_sb = found[3]
            elif content == 'WSS' and fault('cnet-mon-write-accepted'):
                return ''
            else:
                raise Nak('0011')
        except (Nak, Refused):
            if fault('cnet-mon-refused-clears'):
                self.monitors.pop(number, None)
            raise
        self.registered += 1
        if fault('cnet-mon-fifth-lost') and self.registered == 5:
            return ''
        if fault('cnet-mon-kept') and number in self.monitors:
            return ''
        self.monitors[number] = found
        if fault('cnet-mon-snapshot'):
            self.monitors[number] = self.show(found)
        return ''

    def show(self, found):
        if isinstance(found, tuple):
            return self.show_run(*found)
        return self.show_blocks(found[:8] if fault('cnet-mon-eight-blocks') else found)

    def monitor(self, field, rest):
        if len(field) < 2 or not is_hex(field) or int(field, 16) > 15 and not fault('cnet-mon-10-alias'):
            raise Nak('0090' if fault('cnet-mon-range-code') else '0190')
        number = int(field, 16) & (7 if fault('cnet-mon-8-alias') else 15)
        if number not in self.monitors:
            raise Nak('0190' if fault('cnet-mon-none-code') else '0090')
        if not fault('cnet-surplus-y'):
            rest.end()
        found = self.monitors[number]
        if isinstance(found, str):
            return found
        if fault('cnet-mon-sb-ends') and isinstance(found, tuple):
            found = found[:3] + (self.last_sb * 1,)
        for item in [found] if isinstance(found, tuple) else found:
            if fault('cnet-mon-unchecked'):
                self.memory.check(*item[:3], item[3] if isinstance(found, tuple) else 1)
        return self.show(found)
