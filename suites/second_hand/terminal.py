"""A terminal that carries bytes as they are."""
import os
import termios


def open_raw(path, speed=termios.B115200):
    handle = os.open(path, os.O_RDWR | os.O_NOCTTY)
    mode = termios.tcgetattr(handle)
    mode[0] = mode[1] = mode[3] = 0
    mode[2] = termios.CS8 | termios.CREAD | termios.CLOCAL
    mode[4] = mode[5] = speed
    mode[6][termios.VMIN], mode[6][termios.VTIME] = 1, 0
    termios.tcsetattr(handle, termios.TCSANOW, mode)
    return handle
