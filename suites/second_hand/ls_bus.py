"""LS Bus inverter, asked by a Cnet module as LS Bus client (000 and 003 chapter 8)."""
import json

from cnet import ACK, ENQ, EOT, ETX, NAK, Nak, is_hex
from faults import fault

RANGES = ((0x0000, 0x1000), (0x1200, 0x1300))           # from, past the end
READ_ONLY = (*range(0x0000, 0x0004), *range(0x0009, 0x0010))
LONGEST = 256                                            # from ENQ on; what has no EOT until then is dropped


class Words:
    """The inverter's parameters by address."""
    def __init__(self):
        self.data = {}
        self.old = {}                                    # ls-first-read-old: address -> value before the last write
        self.writes = 0
        self.late = {}                                   # ls-write-deferred: stored before the next bytes

    def served(self, address):
        if fault('ls-end-0fff') and address == 0x0FFF or fault('ls-end-12ff') and address == 0x12FF:
            return False
        if fault('ls-1300-served') and address == 0x1300 or fault('ls-gap-served') and 0x1000 <= address < 0x1200:
            return True
        if fault('ls-8000-alias'):
            address &= 0x7FFF
        return any(first <= address < end for first, end in RANGES)

    def read_only(self, address):
        if fault('ls-0003-writable') and address == 3 or fault('ls-000f-writable') and address == 15:
            return False
        if fault('ls-0010-read-only') and address == 0x0010:
            return True
        return address in READ_ONLY

    def place(self, address):
        if fault('ls-1200-alias'):
            address &= 0x0FFF
        if fault('ls-0800-alias') and address < 0x1000:
            address &= 0x07FF
        if fault('ls-8000-alias'):
            address &= 0x7FFF
        return address

    def get(self, address):
        value = self.data.get(self.place(address), 0)
        return self.old.pop(address, value) if fault('ls-first-read-old') else value

    def put(self, address, value):
        self.writes += 1
        if fault('ls-100-writes') and self.writes > 100:
            return
        if fault('ls-value-signed'):
            value = min(value, 0x7FFF)
        self.old[address] = self.get(address)
        (self.late if fault('ls-write-deferred') else self.data)[self.place(address)] = value

    def settle(self):
        self.data.update(self.late)
        self.late.clear()


class LsBusServer:
    gap_seconds = 0.050                                  # no time between characters ends a request: ls-gap-drops alone

    def __init__(self, station=1, count_first=False):
        self.words, self.station, self.count_first = Words(), station, count_first
        self.buffer = bytearray()
        self.noise = self.lost = self.deaf = False
        self.requests = self.last_words = self.refused = self.wrong_sums = 0
        self.last_write = []
        self.last_code = None

    @property
    def pending(self):
        return bool(self.buffer) and fault('ls-gap-drops')

    def gap(self):
        self.buffer.clear()
        return b''

    # ---- set up by a bench
    def control(self, line):
        """Lines of JSON to read words and to set them, read-only ones too."""
        asked = json.loads(line)
        if 'get' in asked:
            values = {name: '%04X' % self.words.data.get(self.words.place(int(name, 16)), 0) for name in asked['get']}
            return json.dumps({'values': values})
        if 'set' not in asked:
            return json.dumps({'error': 'only get and set'})
        for name, value in asked['set'].items():
            self.words.data[self.words.place(int(name, 16))] = int(value, 16)
        return json.dumps({'ok': True})

    # ---- frames
    def feed(self, data):
        out, replies = b'', 0
        self.words.settle()
        for value in data:
            if fault('ls-seven-bit'):
                value &= 0x7F
            reply = self.byte(value)
            if reply:
                out += reply
                replies += 1
            if fault('ls-second-dropped') and replies == 1 or fault('ls-third-dropped') and replies == 2:
                break
        return out

    def byte(self, value):
        """The reply when this byte completes a request, else None."""
        if self.head(value):
            if not self.noise and not self.deaf:
                self.buffer[:] = [ENQ]
            self.deaf = False
            return None
        if not self.buffer:
            self.noise = fault('ls-noise-kills') and value != EOT
            self.deaf = self.deaf or fault('ls-other-reply-kills') and value == ACK
            return None
        if fault('ls-crlf-skipped') and value in b'\r\n':
            return None
        self.buffer.append(value)
        if not self.tail(value):
            if len(self.buffer) >= (512 if fault('ls-buffer-512') else LONGEST):
                self.buffer.clear()
                self.deaf = fault('ls-overrun-next-lost')
            return None
        frame = bytes(self.buffer)
        self.buffer.clear()
        if len(frame) > (40 if fault('ls-buffer-40') else 128 if fault('ls-buffer-128') else
                         255 if fault('ls-buffer-255') else 512):
            return None
        return self.frame(frame[1:-1].decode('latin-1'))

    def head(self, value):
        if fault('ls-head-any') and value in (ACK, NAK) and not self.buffer:
            return True
        kept = fault('ls-enq-no-restart') and self.buffer or fault('ls-enq-late') and len(self.buffer) > 16
        return value == ENQ and not kept

    def tail(self, value):
        if fault('ls-etx-tail') and value == ETX:
            return True
        if fault('ls-eot-unchecked') and self.buffer[3:4] == b'R' and len(self.buffer) == 12:
            return True
        return value == EOT

    def frame(self, text):
        """A request from behind ENQ to before EOT."""
        if len(text) < 5:                                # station, command and sum
            return self.pack(text[2:3] or 'R', 'FE', True) if fault('ls-short-fe') else None
        if self.lost:
            self.lost = False
            return None
        right = self.sum_right(text)
        if not self.station_right(text[:2]):
            self.lost = fault('ls-foreign-next-lost')
            return self.pack(text[2], 'FE', True) if fault('ls-foreign-fe') and not right else None
        self.requests += 1
        if fault('ls-17th-silent') and self.requests % 17 == 0 or fault('ls-256th-silent') and self.requests % 256 == 0:
            return None
        command, rest = text[2], text[3:-2]
        self.wrong_sums, before = 0 if right else self.wrong_sums + 1, self.wrong_sums
        if not right and fault('ls-sum-silent') or right and before >= 3 and fault('ls-three-fe-silent'):
            return None
        try:
            words = self.serve(command, rest, right)
        except Nak as nak:
            return self.refuse(command, nak.code)
        return self.grant(command, rest, words)

    def sum_right(self, text):
        total, got = sum(text[:-2].encode('latin-1')), text[-2:]
        if fault('ls-sum-ignored-w') and text[2] == 'W':
            return True
        if fault('ls-sum-not-hex'):
            got = ''.join(c if is_hex(c) else '0' for c in got)
        if fault('ls-sum-lower-refused') and got != got.upper():
            return False
        want = '%02X' % (total & 255)
        if fault('ls-sum-low-digit'):
            return got[1].upper() == want[1]
        if fault('ls-sum-high-digit'):
            return got[0].upper() == want[0]
        if fault('ls-sum-seven-bits'):
            return is_hex(got) and int(got, 16) & 127 == total & 127
        if fault('ls-sum-enq-too') and got.upper() == '%02X' % (total + ENQ & 255):
            return True
        return got.upper() == want

    def station_right(self, text):
        if fault('ls-station-low-digit'):
            return is_hex(text[1]) and int(text[1], 16) == self.station & 15
        if fault('ls-station-00') and text == '00':
            return True
        if not is_hex(text) or fault('ls-station-lower') and text != text.upper():
            return False
        if fault('ls-station-32'):
            return int(text, 16) & 31 == self.station & 31
        return int(text, 16) == (int(str(self.station), 16) if fault('ls-station-decimal') else self.station)

    def grant(self, command, rest, words):
        values = words
        if fault('ls-eighth-order') and command == 'R' and len(words) == 8:
            values = words[:6] + [words[7], words[6]]
        if fault('ls-long-then-short') and command == 'R' and len(words) == 1 and self.last_words == 8:
            values = words * 2
        if fault('ls-ack-first-word') and command == 'W':
            values = words[:1]
        body = ''.join('%04X' % value for value in values)
        if fault('ls-ack-as-sent') and command == 'W':
            body = rest[5:]
        if fault('ls-data-reply-lower') and command == 'R':
            body = body.lower()
        out = self.pack(command, body, False)
        self.last_words, self.last_code, self.refused = len(words), None, 0
        return out

    def refuse(self, command, code):
        if fault('ls-code-latched'):
            code = self.last_code or code
        self.last_code = code
        self.refused += 1
        if fault('ls-ia-id-swapped-w') and command == 'W':
            code = {'IA': 'ID', 'ID': 'IA'}.get(code, code)
        if fault('ls-nak-four') or fault('ls-long-then-nak') and self.last_words == 8:
            code = '00' + code
        if fault('ls-nak-function-r') and command not in 'RW':
            command = 'R'
        self.last_words = 0
        if fault('ls-ten-refusals-silent') and self.refused >= 10:
            return None
        return self.pack(command, code, True)

    def pack(self, command, body, nak):
        text = ('%02X' % self.station + command + body).encode('latin-1')
        total = sum(text)
        if fault('ls-sum-nak-head') and nak:
            total += NAK
        if fault('ls-sum-after-nak') and not nak and self.last_code:
            total += 1
        if fault('ls-sum-eight-words') and len(body) == 32:
            total -= text[-1]
        check = (b'%02x' if fault('ls-sum-reply-lower') else b'%02X') % (total & 255)
        return bytes([NAK if nak else ACK]) + text + check + bytes([ETX if fault('ls-nak-etx') and nak else EOT])

    # ---- requests
    def serve(self, command, rest, right):
        """The words of an ACK: sum, function, form of the address, count and data, range, rights."""
        if not right and fault('ls-sum-wrong-written') and command == 'W':
            self.request('W', rest)
        if not right and not (fault('ls-function-before-sum') and command not in 'RW'):
            raise Nak('FE')
        if fault('ls-lower-command'):
            command = command.upper()
        if command not in ('R', 'W'):
            if fault('ls-function-code'):
                raise Nak('ID')
            raise Nak('IF')
        return self.request(command, rest)

    def request(self, command, rest):
        write = command == 'W'
        count_first = write and self.count_first and not fault('ls-order-ignored')
        if fault('ls-order-guessed') and write and rest[4:5] != str((len(rest) - 5) // 4):
            count_first = rest[:1] == str((len(rest) - 5) // 4)
        address, count, data = rest[:4], rest[4:5], rest[5:]
        if count_first:
            count, address = rest[:1], rest[1:5]
        address = self.address(address)
        count = self.count(count, write)
        if write:
            return self.write(address, count, data)
        if data and not fault('ls-surplus-read'):
            raise Nak('ID')
        self.range(address, count, False)
        if fault('ls-read-only-hidden') and self.words.read_only(address):
            raise Nak('IA')
        return [self.words.get(a) for a in self.run(address, count)]

    def address(self, text):
        if fault('ls-address-strtol') and len(text) == 4:    # blanks and a sign first, ends at what is no digit
            digits = text.lstrip(' ').removeprefix('+')
            n = next((k for k, c in enumerate(digits) if not is_hex(c)), len(digits))
            return int(digits[:n] or '0', 16)
        if fault('ls-address-lower') and text != text.upper():
            raise Nak('IA')
        if fault('ls-address-decimal') and not text.isdecimal():
            raise Nak('IA')
        if len(text) < 4 or not is_hex(text):
            raise Nak('ID' if fault('ls-address-form-code') else 'IA')
        return int(text, 16)

    def count(self, text, write):
        if fault('ls-count-missing-one') and not text and not write:
            return 1
        if fault('ls-count-masked') and text and 1 <= ord(text) & 15 <= 8:
            return ord(text) & 15
        if fault('ls-count-letters') and not write and text and text in 'ABCDEF':
            return int(text, 16)
        highest = '9' if fault('ls-count-9') and not write else \
            '7' if fault('ls-count-8-refused') and write else '8'
        if fault('ls-count-0-ack') and text == '0' and not write:
            return 0
        if not text or not '1' <= text <= highest:
            raise Nak('IA' if fault('ls-count-code') else 'ID')
        return int(text)

    def values(self, text, count, address):
        """The words to write."""
        if fault('ls-surplus-write') or fault('ls-surplus-half') and len(text) < 4 * count + 4:
            text = text[:4 * count]
        if fault('ls-data-short'):
            text = text.ljust(4 * count, '0')
        if len(text) != 4 * count:
            raise Nak('ID')
        parts = [text[k:k + 4] for k in range(0, len(text), 4)]
        if fault('ls-data-first-checked'):
            parts[1:] = [''.join(c if is_hex(c) else '0' for c in part) for part in parts[1:]]
        for k, part in enumerate(parts):
            if not is_hex(part) or fault('ls-data-lower-refused') and part != part.upper():
                raise Nak('IA' if fault('ls-data-code') else 'ID')
            if fault('ls-partial-data') and len(parts) > 1 and self.words.served(address + k):
                self.words.put(address + k, int(part, 16))
        return [int(part, 16) for part in parts]

    def range(self, address, count, write):
        if fault('ls-page-refused') and address >> 8 != address + count - 1 >> 8:
            raise Nak('IA')
        run = [address + k for k in range(count)] if fault('ls-page-pointer') else self.run(address, count)
        if fault('ls-range-first') and not write:
            run = run[:1]
        if fault('ls-range-last'):
            run = [address + count - 1 & 0xFFFF]
        if not all(self.words.served(a) for a in run):
            raise Nak('ID' if fault('ls-range-code') else 'IA')

    def run(self, address, count):
        if fault('ls-page-wraps') or fault('ls-page-pointer'):
            return [address & 0xFF00 | address + k & 255 for k in range(count)]
        if fault('ls-run-joins') and address <= 0x0FFF:  # by the index in one table
            return [address + k + (0x200 if address + k > 0x0FFF else 0) for k in range(count)]
        return [address + k for k in range(count)]

    def write(self, address, count, data):
        values = self.values(data, count, address)
        run = self.run(address, count)
        try:
            self.range(address, count, True)
        except Nak:
            if fault('ls-partial-range'):
                self.put(run, values, lambda a: self.words.served(a) and not self.words.read_only(a))
            raise
        self.rights(run, values)
        if fault('ls-refused-next-lost') and self.last_code:
            return values
        if fault('ls-eighth-lost'):
            run = run[:7]
        self.put(run, values, lambda a: not (fault('ls-rights-skipped') and self.words.read_only(a)))
        if fault('ls-eight-then-one') and count == 1 and len(self.last_write) == 8:
            self.put([address + 1], self.last_write[1:2], self.words.served)
        self.last_write = values
        return values

    def rights(self, run, values):
        held = [a for a in run[:1] if self.words.read_only(a)] if fault('ls-rights-first') else \
            [a for a in run if self.words.read_only(a)]
        if fault('ls-five-refusals-lock') and self.refused >= 5:
            held = run
        if not held or fault('ls-read-only-written') or fault('ls-rights-skipped'):
            return
        if fault('ls-partial-rights'):
            self.put(run[:run.index(held[0])], values, lambda a: True)
        raise Nak('IA' if fault('ls-rights-code') else 'WM')

    def put(self, run, values, wanted):
        for address, value in zip(run, values):
            if wanted(address):
                self.words.put(address, value)
