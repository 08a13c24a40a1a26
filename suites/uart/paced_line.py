"""A serial line between two UARTs of a virtual machine: each byte takes as long as its speed demands.

The ends are ptys, which the machine opens as serial ports: it sets their speed as its guest does. Where the two ends differ in
speed, what arrives is rubbish, as on a real line.
"""
import os
import pty
import select
import termios
import threading
import time
import tty

SPEEDS = {getattr(termios, name): int(name[1:]) for name in dir(termios) if name[0] == "B" and name[1:].isdigit()}
FRAME_GAP = 0.01  # what comes later is another frame


class End:
    """One end of the line: `path` is for the machine."""

    def __init__(self):
        self.ours, self.theirs = pty.openpty()
        tty.setraw(self.theirs)
        self.path = os.ttyname(self.theirs)
        self.due = []  # (moment, byte) that come out here
        self.busy_until = 0.0

    def speed(self):
        return SPEEDS.get(termios.tcgetattr(self.theirs)[5], 9600)


class PacedLine:
    """Runs in a thread of its own until close()."""

    def __init__(self):
        self.ends = (End(), End())
        self.paced = True  # else at once, as a line that is none
        self.bits = 10  # of a character: a pty does not tell parity or stop bits
        self._frames, self._lost, self._again, self._heard = 0, 0, 0, 0.0
        self._copy = b""
        self._wake, self._woken = os.pipe()
        self._over = False
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def close(self):
        self._over = True
        os.write(self._woken, b".")
        self._thread.join()

    def lose(self, number):
        """Loses so manieth frame that comes from the second end, from now on."""
        self._frames, self._lost = 0, number

    def again(self, number):
        """So manieth frame from the second end comes a second time, when the next request is on its way."""
        self._frames, self._again = 0, number

    def lost(self):
        return self._frames >= self._lost

    def _run(self):
        while not self._over:
            moments = [end.due[0][0] for end in self.ends if end.due]
            wait = max(0.0, min(moments) - time.monotonic()) if moments else None
            readable, _, _ = select.select([end.ours for end in self.ends] + [self._wake], [], [], wait)
            if self._wake in readable:
                os.read(self._wake, 64)
            for end, far in (self.ends, self.ends[::-1]):
                if end.ours in readable:
                    self._take(end, far)
            for end in self.ends:
                self._hand_out(end)

    def _take(self, end, far):
        data = os.read(end.ours, 4096)
        if end is self.ends[1]:
            now = time.monotonic()
            self._frames += now - self._heard > FRAME_GAP
            self._heard = now
            if self._frames == self._lost:
                return
            if self._frames == self._again:
                if not self._copy:
                    threading.Timer(0.035, self._repeat, (end, far)).start()
                self._copy += data
        self._pass(data, end, far)

    def _repeat(self, end, far):
        self._again = 0
        self._pass(self._copy, end, far)
        self._copy = b""
        os.write(self._woken, b".")

    def _pass(self, data, end, far):
        speed = end.speed()
        if far.speed() != speed:
            data = bytes(byte ^ 0xA5 for byte in data)
        at = max(time.monotonic(), far.busy_until)
        for byte in data:
            at += self.bits / speed if self.paced else 0
            far.due.append((at, byte))
        far.busy_until = at

    def _hand_out(self, end):
        now = time.monotonic()
        ready = bytes(byte for at, byte in end.due if at <= now)
        del end.due[: len(ready)]
        if ready:
            os.write(end.ours, ready)
