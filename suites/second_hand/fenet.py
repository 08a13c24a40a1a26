"""XGT FEnet server (001 chapters 5 and 6)."""
from faults import fault
from memory import AREAS, READ_ONLY, SIZE, Refused, index_of, split_name

LSIS, GLOFA = b'LSIS-XGT\0\0', b'LGIS-GLOFA'
KINDS = {0: 'X', 1: 'B', 2: 'W', 3: 'D', 4: 'L', 0x14: 'B'}
CODES = {'percent': 0x11, 'area': 3, 'type': 2, 'form': 0x11, 'range': 4}
PLC_INFO, CPU = 0x0107, 0xB0                    # our CPU type, RUN; XGB (MK)


def word(data, at=0):
    return int.from_bytes(data[at:at + 2], 'little')


def put(value):
    return (value & 0xFFFF).to_bytes(2, 'little')


class Nak(Exception):
    def __init__(self, code):
        super().__init__(code)
        self.code = code


class FenetServer:
    header = 20

    def __init__(self, memory, position=1, header_check='ignore'):
        self.memory, self.position, self.header_check = memory, position, header_check
        self.requests = self.last_size = 0
        self.last_invoke = b'\0\0'
        self.last_type = b'\0\0'
        self.invoke_of = {}
        self.partial = bytearray()

    def size(self, buffer):
        return None if len(buffer) < 20 else 20 + word(buffer, 16)

    def datagram(self, data):
        if len(data) < 20:
            return b''
        return self.answer(data, None, len(data) == 20 + word(data, 16))

    def answer(self, frame, connection, whole=True):
        company, invoke, body = frame[:10], frame[14:16], frame[20:]
        self.requests += 1
        if fault('fe-17th-silent') and self.requests % 17 == 0:
            return b''
        if fault('fe-source-checked') and frame[13] != 0x33:
            return b''
        command, kind = word(body), body[2:4].ljust(2, b'\0')
        try:
            self.check_header(frame, whole)
            answer = self.serve(command, body)
            code = None
        except Nak as nak:
            code = nak.code
        except Refused as refused:
            code = CODES[refused.why]
            if fault('fe-code-end') and code == 4 or fault('fe-code-form') and code == 0x11:
                code = 3
        if code is not None:
            reply = put(command + 1) + kind + b'\0\0\xff\xff' + put(code)
            if fault('fe-nak-command') and command == 0x58:
                reply = put(0x55) + reply[2:]
            if fault('fe-nak-type'):
                reply = reply[:2] + b'\0\0' + reply[4:]
        else:
            if fault('fe-long-stale') and self.last_size > 300 and kind != b'\x14\0':
                kind = self.last_type
            if fault('fe-continuous-type') and command == 0x58 and kind == b'\x14\0':
                kind = b'\1\0'
            reply = put(command + 1) + kind + b'\0\0\0\0' + answer
        identity = company if company in (LSIS, GLOFA) or fault('fe-id-echo') else LSIS
        if fault('fe-glofa-lsis'):
            identity = LSIS
        back = invoke
        if fault('fe-invoke-swap') and command == 0x54 and kind == b'\x14\0' and code is None:
            back = invoke[::-1]
        if fault('fe-invoke-nak') and code is not None:
            back = self.last_invoke
        if fault('fe-invoke-last-connection') and command == 0x58:
            back = next((i for c, i in self.invoke_of.items() if c != connection), invoke)
        self.invoke_of[connection] = invoke
        self.last_invoke, self.last_size, self.last_type = invoke, len(reply), kind
        source = 0x33 if fault('fe-source-nak') and code is not None else 0x11
        length = len(reply)
        if fault('fe-length-dword') and kind == b'\3\0' and command == 0x54 and code is None:
            length -= 2 * (word(answer) - 1)
        head = identity + put(PLC_INFO) + bytes([0xA0 if fault('fe-cpu-a0') else CPU, source]) + back \
            + put(length) + bytes([self.position])
        check = sum(head) & 255
        if fault('fe-check-nak') and code is not None:
            check = 0
        if fault('fe-check-carry'):
            check = sum(head[:18]) & 255
        return head + bytes([check]) + reply

    def check_header(self, frame, whole):
        company = frame[:10]
        if company not in (LSIS, GLOFA) and not (fault('fe-id-half') and company[:4] in (b'LSIS', b'LGIS')):
            raise Nak(0x75)
        right = frame[19] == sum(frame[:19]) & 255
        if self.header_check == 'strict' and not right or fault('fe-check-enforced') and not right \
                or self.header_check == 'zero_or_valid' and not right and frame[19]:
            raise Nak(0x77)
        if not whole:
            raise Nak(0x76)

    def serve(self, command, body):
        if len(body) >= 2 and command not in (0x54, 0x58):
            raise Nak(0x24 if fault('fe-code-command') else 0x78)
        if len(body) < 8:
            raise Nak(0x76)
        kind, count = word(body, 2), word(body, 6)
        if kind not in KINDS:
            raise Nak(0x24)
        if fault('fe-reserved-checked') and body[4:6] != b'\0\0':
            raise Nak(0x24)
        write, continuous = command == 0x58, kind == 0x14
        limit = 15 if fault('fe-count-16-refused') else 17 if fault('fe-count-17') and not write else 16
        if count > (1 if continuous else limit):
            raise Nak(1)
        if count == 0 and not (fault('fe-count-0') and not write):
            raise Nak(1)
        self.body, self.at = body, 8
        if continuous:
            return self.continuous(write)
        return self.individual(KINDS[kind], count, write)

    def take(self, n):
        if self.at + n > len(self.body):
            raise Nak(0x76)
        self.at += n
        return self.body[self.at - n:self.at]

    def end(self):
        if self.at < len(self.body):
            raise Nak(0x76)

    def name(self, wanted, write, continuous=False):
        length = word(self.take(2))
        if not 4 <= length <= (15 if fault('fe-name-16-refused') else 17 if fault('fe-name-17') else 16):
            raise Nak(0x11)
        text = self.take(length).decode('latin-1')
        area, kind, digits = None, None, None
        try:
            area, kind, digits = split_name(text, AREAS)
        except Refused as refused:
            if continuous and refused.why == 'type':
                raise Nak(0x12) from None
            raise
        if write and area in READ_ONLY and not (fault('mem-f-writable') and area == 'F'
                                                or fault('mem-n-writable') and area == 'N'):
            raise Nak(4 if fault('fe-code-readonly') else 3)
        if kind != wanted and not (fault('fe-type-mismatch') and not write and not continuous):
            raise Nak(0x12 if continuous and not fault('fe-code-continuous') else 2)
        return area, kind, index_of(area, kind, digits)

    def individual(self, kind, count, write):
        names = [self.name(kind, write) for _ in range(count)]
        if not write:
            self.end()
            for name in names:
                self.memory.check(*name)
            parts = []
            for area, kind, index in names:
                size = 4 if fault('fe-lword-size') and kind == 'L' else SIZE[kind]
                parts.append(put(size) + self.memory.get(area, kind, index))
            if fault('fe-last-block-first') and count == 16:
                parts[14:] = parts[:13:-1]
            return put(count) + b''.join(parts)
        data = []
        for k, name in enumerate(names):
            size = word(self.take(2))
            if size != SIZE[kind] and not (fault('fe-size-ignored') and size > SIZE[kind]):
                raise Nak(5)
            value = self.take(size)
            if kind == 'X' and fault('fe-bit-nonzero'):
                value = bytes([value[0] != 0])
            data.append(value[:SIZE[kind]])
            if fault('fe-partial') and k + 1 < count:
                self.memory.check(*name)
                self.memory.put(*name, data[-1])
        self.end()
        for name in names:
            self.memory.check(*name)
        for name, value in zip(names, data):
            self.memory.put(*name, value)
        return put(1 if fault('fe-write-count') else count)

    def continuous(self, write):
        if word(self.body, 6) == 0:                      # fe-count-0 only
            return put(0)
        area, _, index = self.name('B', write, continuous=True)
        size = word(self.take(2))
        if size == 0 and not (fault('fe-zero-bytes') and not write):
            raise Nak(5)
        if size > (511 if fault('fe-512-refused') and not write else 514 if fault('fe-513') and write else 512):
            raise Nak(5)
        data = self.take(size) if write else b''
        self.end()
        self.memory.check(area, 'B', index, size)
        if write:
            for k, value in enumerate(data):
                if not (fault('fe-odd-write') and size % 2 and k == size - 1):
                    self.memory.put(area, 'B', index + k, bytes([value]))
            return put(1)
        if fault('fe-odd-start'):
            index &= ~1
        out = b''.join(self.memory.get(area, 'B', index + k) for k in range(size))
        return put(1) + put(size + (size % 2 if fault('fe-odd-size') else 0)) + out
