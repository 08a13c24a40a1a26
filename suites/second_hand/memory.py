"""XBC-H memory (Cnet EN 7.1.4, FEnet EN A.1.1) and device names, used by every protocol."""
from faults import fault

AREAS = {'P': 1024, 'M': 1024, 'K': 4096, 'F': 1024, 'T': 1024, 'C': 1024, 'L': 2048,
         'N': 5120, 'D': 10240, 'U': 352, 'Z': 128, 'R': 10240}
READ_ONLY = 'FN'
SIZE = {'X': 1, 'B': 1, 'W': 2, 'D': 4, 'L': 8}
HEX = '0123456789abcdefABCDEF'


class Refused(Exception):
    """why: percent, area, type, form, range"""
    def __init__(self, why):
        super().__init__(why)
        self.why = why


def split_name(text, areas):
    """'%MW100' -> ('M', 'W', '100')"""
    if text[:1] != '%' and not fault('cnet-percent-any'):
        raise Refused('percent')
    if len(text) < 2:
        raise Refused('form')
    if (fault('cnet-name-lower') or fault('fe-name-lower')) and text[1].islower():
        raise Refused('area')
    area = text[1].upper()
    if area not in areas or (fault('mem-r-missing') and area == 'R'):
        raise Refused('area')
    if len(text) < 3:
        raise Refused('form')
    kind = text[2].upper()
    if kind not in SIZE:
        raise Refused('type')
    return area, kind, text[3:]


def index_of(area, kind, digits):
    """The element number: bits as word * 16 + bit, contacts of T and C by number."""
    if not digits or any(c not in HEX for c in digits):
        raise Refused('form')
    if kind == 'X' and area not in 'TC':
        if fault('mem-bit-lower-digit') and digits[-1] in 'abcdef':
            raise Refused('form')
        if fault('mem-l-bits-flat') and area == 'L' and digits.isdecimal():
            return int(digits)
        word, bit = digits[:-1] or '0', int(digits[-1], 16)
        if not word.isdecimal():
            raise Refused('range')
        return int(word) * 16 + bit
    if not digits.isdecimal():
        if fault('cnet-hex-word'):
            return int(digits, 16)
        raise Refused('form' if fault('cnet-hex-word-code') else 'range')
    return int(digits)


class Memory:
    def __init__(self):
        self.data = {area: bytearray(2 * words) for area, words in AREAS.items()}
        self.contacts = {'T': bytearray(1024), 'C': bytearray(1024)}
        self.old = None                      # mem-read-after-bit: (area, byte index, word before the bit write)

    def words(self, area):
        n = AREAS[area]
        if fault('mem-k-short') and area == 'K':
            n = 2560
        if fault('mem-l-short') and area == 'L':
            n = 1280
        if fault('mem-n-short') and area == 'N':
            n = 3936
        if fault('mem-u-short') and area == 'U':
            n = 256
        if fault('mem-d-last-refused') and area == 'D':
            n -= 1
        if fault('mem-c-one-more') and area == 'C':
            n += 1
        return n

    def check(self, area, kind, index, count=1):
        words = self.words(area)
        if fault('mem-range-start-only'):
            count = 1
        if kind == 'X':
            limit = len(self.contacts[area]) if area in 'TC' else words * 16
        else:
            limit = words * 2 // SIZE[kind]
            if fault('mem-t-byte-limit') and area == 'T' and kind == 'B':
                limit = words
        if index + count > limit:
            raise Refused('range')

    def place(self, area, i):
        if fault('mem-d-alias') and area == 'D' and i >= 16384:
            i -= 16384
        if fault('mem-m-alias') and area == 'M':
            i &= ~1024
        if fault('mem-r-high-in-d') and area == 'R' and i >= 20000:
            area = 'D'
        return area, i % len(self.data[area])

    def read(self, area, i, n):
        out = bytearray()
        for k in range(i, i + n):
            a, j = self.place(area, k)
            out.append(self.data[a][j])
        if fault('mem-read-after-bit') and self.old:
            old_area, old_i, old_word = self.old
            if old_area == area and i <= old_i and old_i + 2 <= i + n:
                out[old_i - i:old_i - i + 2] = old_word
                self.old = None
        return bytes(out)

    def write(self, area, i, data):
        for k, value in enumerate(data):
            a, j = self.place(area, i + k)
            self.data[a][j] = value

    def get_bit(self, area, number):
        if area in self.contacts:
            if fault('mem-t-contact-value') and area == 'T':
                return int(any(self.data['T'][2 * number:2 * number + 2]))
            return self.contacts[area][number]
        if fault('mem-u-bit-page') and area == 'U' and number >= 320 * 16:
            number -= 320 * 16
        a, j = self.place(area, number // 8)
        return self.data[a][j] >> (number % 8) & 1

    def set_bit(self, area, number, value):
        if area in self.contacts:
            self.contacts[area][number] = value
            if fault('mem-c-contact-count') and area == 'C':
                self.data['C'][2 * number:2 * number + 2] = b'\0\0'
            return
        if fault('mem-u-bit-page') and area == 'U' and number >= 320 * 16:
            number -= 320 * 16
        if fault('mem-read-after-bit'):
            self.old = (area, number // 16 * 2, bytes(self.data[area][number // 16 * 2:number // 16 * 2 + 2]))
        a, j = self.place(area, number // 8)
        self.data[a][j] = self.data[a][j] & ~(1 << number % 8) | value << number % 8
        if fault('mem-bit-high-byte') and number % 16 >= 8:
            self.data[a][j - 1] = 0

    def get(self, area, kind, index):
        """One element, low byte first."""
        if kind == 'X':
            return bytes([self.get_bit(area, index)])
        if fault('mem-k-odd-byte') and area == 'K' and kind == 'B':
            index &= ~1
        data = self.read(area, index * SIZE[kind], SIZE[kind])
        if fault('mem-lword-read-order') and kind == 'L':
            data = data[4:] + data[:4]
        return data

    def put(self, area, kind, index, data):
        if kind == 'X':
            self.set_bit(area, index, data[0] & 1)
            return
        if fault('mem-dword-write-order') and kind == 'D':
            data = data[2:] + data[:2]
        self.write(area, index * SIZE[kind], data)
