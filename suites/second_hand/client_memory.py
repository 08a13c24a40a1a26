"""The memory of a PLC that asks: what it saves, and what it sends."""
from client_faults import fault
from memory import AREAS, SIZE, Memory, index_of, split_name


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
