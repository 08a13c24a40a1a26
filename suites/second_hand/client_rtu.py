"""The Modbus RTU client (Cnet EN chapter 9): its requests, and what it makes of replies."""
from client_end import LENGTH, REFUSED, TIME_OUT, WRONG_CHECK, WRONG_DRIVER, WRONG_STATION, Done
from client_faults import fault
from modbus import crc16


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
        self.request = frame + crc16(frame)
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
                if crc16(self.buffer[:n - 2]) == self.buffer[n - 2:n]:
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
        return len(self.buffer) >= 4 and crc16(self.buffer[:-2]) == self.buffer[-2:]

    def gap_at(self, gap):
        if not self.buffer:
            return None
        return self.last + (self.end_gap if self.whole() and gap <= 0.020 else gap)

    def timed_out(self, room):
        if self.whole():
            self.gap(room)
        raise Done(TIME_OUT)

    def check_right(self, frame):
        want, got = crc16(frame[:-2]), frame[-2:]
        if fault('crc-exception') and frame[1] & 0x80:
            want = crc16(bytes([frame[0], frame[1] & 0x7f]) + frame[2:-2])
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
