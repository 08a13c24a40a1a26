#!/usr/bin/env python3
"""Which single faults of the second-hand PLC a tool finds: one run a fault, a line a protocol.

  shares.py FIELDPROOF [--mode run|derived|explore] [--protocol P] [--only FAULT]... [--jobs N]

A fault is found where the run is red (exit 1). Cases of decisions that the device reads otherwise are left
out, and `explore` judges by an advisory profile, where what nobody prints is learnt, so that the healthy
device is green; that is checked first."""
import argparse
import concurrent.futures
import pathlib
import subprocess
import sys
import tempfile

DEVICE = pathlib.Path(__file__).parent / 'device.py'
FILTER = '*:-xgt_cnet/line/*:-xgt_fenet/names/no_area_letter/*'


def faults():
    listing = subprocess.run([sys.executable, '-B', DEVICE, '--list-faults'], capture_output=True, text=True, check=True)
    for line in listing.stdout.splitlines():
        name, protocols, _ = line.split('\t')
        for protocol in protocols.split(','):
            yield protocol.strip(), name


def endpoint(protocol, fault):
    where = {'modbus-tcp': ' --listen 127.0.0.1:{port}',
             'xgt-fenet': ' --listen 127.0.0.1:{port} --udp 127.0.0.1:{udp_port}'}.get(protocol, ' --tty {tty}')
    command = f'exec:{sys.executable} -B {DEVICE} --protocol {protocol}{where}'
    if protocol == 'ls-bus':
        command += ' --station {station} --write-order {write_order} --control'
    if protocol == 'modbus-rtu':
        command += ' --gap-ms 4'  # on a pty no pause falls into a frame: 3.5 characters at 9600 are enough
    if fault:
        command += ' --fault ' + fault
    return command + ('' if '{tty}' in where else '?protocol=' + protocol)


def exit_code(tool, mode, protocol, fault, requests):
    with tempfile.TemporaryDirectory() as out:
        command = [tool, 'explore' if mode == 'explore' else 'run', '--endpoint', endpoint(protocol, fault),
                   '--protocol', protocol, '--out', out]
        if mode == 'explore':
            # What nobody says is its own reading, to which it is held.
            command += ['--seed', '1', '--requests', str(requests), '--fail-fast']
            if protocol != 'ls-bus':
                command += ['--profile', 'xbc-dxxxh']
        else:
            command += ['--role', 'server', '--filter', FILTER, '--max-failures', '1']
        if mode == 'derived':
            command += ['--derived']
        if protocol == 'ls-bus':
            command += ['--control', '-', '--profile', 'inverter']  # the only way to set read-only words
        return subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('tool')
    parser.add_argument('--mode', choices=['run', 'derived', 'explore'], default='run')
    parser.add_argument('--protocol')
    parser.add_argument('--only', action='append', default=[])
    parser.add_argument('--requests', type=int, default=3000, help='of explore')
    parser.add_argument('--jobs', type=int, default=2)
    given = parser.parse_args()
    pairs = [(protocol, fault) for protocol, fault in faults()
             if given.protocol in (None, protocol) and (not given.only or fault in given.only)]

    def code_of(pair):
        return exit_code(given.tool, given.mode, *pair, given.requests)

    healthy = sorted({protocol for protocol, _ in pairs})
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        for protocol, code in zip(healthy, pool.map(code_of, [(protocol, '') for protocol in healthy])):
            if code != 0:
                sys.exit(f'{protocol}: the healthy device is not green (exit {code})')
        codes = dict(zip(pairs, pool.map(code_of, pairs)))
    for protocol in healthy:
        own = {fault: code for (of, fault), code in codes.items() if of == protocol}
        found = [fault for fault, code in own.items() if code == 1]
        print(f'{protocol}: {len(found)} of {len(own)}')
        for fault, code in own.items():
            if code != 1:
                print(f'  not {fault}' + (f' (exit {code})' if code else ''))


if __name__ == '__main__':
    main()
