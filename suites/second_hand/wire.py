"""The same device as a process: terminals, sockets, connections and times."""
import os
import pty
import select
import socket
import subprocess
import sys
import time
import tty

HERE = os.path.dirname(os.path.abspath(__file__))
t = sys.modules['__main__']


class Process:
    def __init__(self, protocol, fault=None, *more):
        command = [sys.executable, os.path.join(HERE, 'device.py'), '--protocol', protocol, *more]
        if fault:
            command += ['--fault', fault]
        if protocol in (t.T, t.F):
            command += ['--listen', '127.0.0.1:0']
        else:
            self.master, slave = pty.openpty()
            tty.setraw(self.master)
            command += ['--tty', os.ttyname(slave)]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        line = self.process.stdout.readline()
        if protocol in (t.T, t.F):
            self.port = int(line.rsplit(':', 1)[1])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()
        if hasattr(self, 'master'):
            os.close(self.master)

    def serial(self, *parts, wait=0.25):
        """Bytes are sent, numbers are pauses; what comes back until `wait` seconds of silence."""
        out = b''
        for part in parts:
            if isinstance(part, bytes):
                os.write(self.master, part)
            else:
                time.sleep(part)
        while select.select([self.master], [], [], wait)[0]:
            out += os.read(self.master, 4096)
        return out

    def connect(self):
        try:
            s = socket.create_connection(('127.0.0.1', self.port), 2)
        except ConnectionResetError:        # reset before connect() saw the end of the handshake
            return None
        s.settimeout(0.5)
        return s


def ask(s, data=b'', end=False):
    """The answer, 'RST', 'FIN' or 'silence'."""
    if s is None:
        return 'RST'
    try:
        if data:
            s.sendall(data)
        if end:
            s.shutdown(socket.SHUT_WR)
        got = s.recv(4096)
        return got.hex() if got else 'FIN'
    except (ConnectionResetError, BrokenPipeError):
        return 'RST'
    except TimeoutError:
        return 'silence'


def network_scene(protocol, scene, fault):
    request = t.mbap(bytes.fromhex('0300000001')) if protocol == t.T else t.fe(t.rd('%MW0'))
    more = ('--wait', '1') if scene == 'wait' else ()
    with Process(protocol, fault, *more) as p:
        out = []
        if scene == 'limit':
            sockets = [p.connect() for _ in range(5)]
            for s in sockets:
                time.sleep(0.05)
                out.append(ask(s, request))
            out += [ask(s, request) for s in sockets[:2]]
        elif scene == 'end':
            s = p.connect()
            out = [ask(s, request), ask(s, end=True)]
        elif scene == 'leak':
            for _ in range(4):
                s = p.connect()
                if s:
                    s.sendall(request[:9])
                time.sleep(0.05)
                out.append(ask(s, end=True))
            s = p.connect()
            out.append(ask(s, request))
        elif scene == 'wait':
            s = p.connect()
            for _ in range(4):
                out.append(ask(s, request))
                time.sleep(0.4)
            time.sleep(1)
            out.append(ask(s, request))
        elif scene == 'segments':
            s = p.connect()
            s.sendall(request[:9])
            time.sleep(0.05)
            out = [ask(s, request[9:] + request), ask(s, request)]
        return out


SCENES = {'net-fifth-accepted': 'limit', 'net-fourth-refused': 'limit', 'net-fifth-disturbs': 'limit',
          'net-fin-answered': 'end', 'net-slot-leak': 'leak', 'net-wait-not-restarted': 'wait'}


def run():
    lines, covered, healthy = [], set(), {}
    for protocol, request in ((t.C, t.cnet('01rSS0104%MW0')), (t.R, t.rtu(bytes.fromhex('0300000001'))),
                              (t.A, t.asc(bytes.fromhex('0300000001')))):
        with Process(protocol) as p:
            lines.append('wire %s\t%r\t%r\t%r' % (protocol, p.serial(request),
                                                  p.serial(request[:5], 0.15 if protocol != t.A else 1.3, request[5:]),
                                                  p.serial(b'\0xyz' if protocol != t.R else b'', 0.1, request)))
            if protocol == t.A:
                healthy[t.A] = p.serial(request[:5], 0.4, request[5:])
    with Process(t.A, 'asc-gap-short') as p:
        faulty = p.serial(request[:5], 0.4, request[5:])
        lines.append('asc-gap-short\t%s\t%r\t%r' % (t.A, healthy[t.A], faulty))
        if faulty != healthy[t.A]:
            covered.add(('asc-gap-short', t.A))
    for protocol in (t.T, t.F):
        for scene in ('limit', 'end', 'leak', 'wait', 'segments'):
            healthy[scene] = network_scene(protocol, scene, None)
            lines.append('wire %s\t%s\t%s' % (protocol, scene, ' '.join(healthy[scene])))
        for fault, scene in SCENES.items():
            faulty = network_scene(protocol, scene, fault)
            lines.append('%s\t%s\t%s' % (fault, protocol, ' '.join(faulty)))
            if faulty != healthy[scene]:
                covered.add((fault, protocol))
    return lines, covered
