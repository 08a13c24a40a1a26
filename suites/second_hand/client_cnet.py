"""The XGT client (Cnet EN chapter 7): its requests, and what it makes of replies."""
from client_end import LENGTH, NOT_HEX, NO_HEAD, NO_TAIL, RANGE, REFUSED, TIME_OUT, WRONG_CHECK, WRONG_DRIVER, WRONG_STATION, Done
from client_faults import fault
from client_memory import unpadded
from cnet import ACK, ENQ, EOT, ETX, NAK
from memory import AREAS, SIZE, index_of, split_name

KINDS = {'bit': 'X', 'byte': 'B', 'word': 'W', 'dword': 'D', 'lword': 'L'}
HEX = '0123456789ABCDEFabcdef'


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
