"""A bad line between two ptys: noisy_line.py LINK TTY SEED. LINK is made, as the bench's end of it.

A bit of every twelfth burst flips, whichever way it goes.
"""
import os
import random
import select
import sys
import tty


def main():
    link, device, noise = sys.argv[1], os.open(sys.argv[2], os.O_RDWR | os.O_NOCTTY), random.Random(int(sys.argv[3]))
    bench, slave = os.openpty()  # the slave stays open: the line outlives who uses it
    for port in (device, bench, slave):
        tty.setraw(port)
    os.symlink(os.ttyname(slave), link)
    print("ready", flush=True)
    while True:
        for port in select.select([bench, device], [], [])[0]:
            data = bytearray(os.read(port, 4096))
            if noise.randrange(12) == 0:
                data[noise.randrange(len(data))] ^= 1 << noise.randrange(8)
            os.write(device if port == bench else bench, bytes(data))


main()
