#!/usr/bin/env python3
"""A second-hand P2P client of an XBC-H: asks over a serial line what the lines of --stimulus say, healthy or with one single fault."""
import argparse
import json
import os
import select
import sys
import termios
import time

import client_faults
from client_cnet import KINDS, Cnet
from client_end import NO_HEAD, RANGE, REFUSED, TIME_OUT, WRONG_CHECK, Done
from client_faults import fault
from client_memory import Device, unpadded
from client_rtu import Rtu
from cnet import CnetServer
from memory import SIZE
from terminal import open_raw

CLOCKS = {'F90': 0.020, 'F92': 0.200, 'F93': 1.000, '_T20MS': 0.020, '_T200MS': 0.200, '_T1S': 1.000}
FOLLOWS = ['clock', 'memory', 'busy', 'mode', 'link', 'power_cycle', 'channel', 'time_out', 'delay', 'character_time', 'line', 'names']


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
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--protocol', choices=['xgt-cnet', 'modbus-rtu'])
    parser.add_argument('--tty', help='terminal of the line')
    parser.add_argument('--aux', metavar='PATH', help='terminal on which the PLC is XGT server, station 1 (the --aux of the bench)')
    parser.add_argument('--station', type=int, default=0, help='of the client itself, which no frame carries')
    parser.add_argument('--fault', metavar='NAME')
    parser.add_argument('--list-faults', action='store_true')
    options = parser.parse_args()
    if options.list_faults:
        for name, (protocols, text) in client_faults.FAULTS.items():
            print(name, ','.join(protocols), text, sep='\t')
        return
    if not options.protocol or not options.tty:
        parser.error('--protocol and --tty are needed')
    if options.fault:
        if options.protocol not in client_faults.FAULTS.get(options.fault, ((),))[0]:
            parser.error('no fault %s of %s' % (options.fault, options.protocol))
        client_faults.set_fault(options.fault)
    handle = open_raw(options.tty, termios.B9600)
    try:
        serve(Client(Cnet() if options.protocol == 'xgt-cnet' else Rtu(), handle, options.station), handle,
              open_raw(options.aux, termios.B9600) if options.aux else None)
    except KeyboardInterrupt:
        sys.exit(0)


if __name__ == '__main__':
    main()
