#!/usr/bin/env python3
"""fieldproof on the UART drivers of a kernel: 8250 and FTDI, in a small virtual machine (machine.py).

    suites/uart/uart_test.py FIELDPROOF BROKEN_SERVER [PART OF A TEST'S NAME]

BROKEN_SERVER is the xgt_cnet_broken_server of the same build. Exit codes: 0 all holds, 1 something does not, 77 skipped. Needs
qemu-system-x86, busybox-static and cpio; the kernel is fetched as a package and not installed. Without KVM.
"""
import json
import re
import sys
import tempfile
import time
from pathlib import Path

sys.dont_write_bytecode = True
from machine import Files, Machine, fetch_kernel, missing_programs  # noqa: E402

SKIPPED = 77
SOURCE = Path(__file__).resolve().parents[2]
RUN = "fieldproof run --role server --allow-write M,D,L --filter"
READ = "'xgt_cnet/rss/refused/lower:xgt_cnet/rss/bit_areas/l:xgt_cnet/rss/bit_areas/m'"
FEW = "xgt_cnet/rss/bit_areas/m"
ONE = "xgt_cnet/rss/refused/lower"
NOT_EXACT = "inter_character_floor_ms=20"  # the line of a busy machine pauses where that of a UART does not
SETTINGS = [(speed, bits + parity + stop) for speed in (1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200)
            for bits in "78" for parity in "NEO" for stop in "12"]
PARITIES = {"N": "-parenb -parodd", "E": "parenb -parodd", "O": "parenb parodd"}
RECONFIGURE = """#!/bin/sh
# PORT FAR SPEED FRAME: notes what PORT was set to until now, and sets FAR to this line.
stty -a -F $1 2>/dev/null >>/tmp/${1##*/}.settings
case $4 in ?N?) parity="-parenb -parodd" ;; ?E?) parity="parenb -parodd" ;; ?O?) parity="parenb parodd" ;; esac
case $4 in ??1) stop=-cstopb ;; ??2) stop=cstopb ;; esac
stty -F $2 $3 cs${4%??} $parity $stop
"""
UARTS, ADAPTERS = ("/dev/ttyS1", "/dev/ttyS2"), ("/dev/ttyUSB0", "/dev/ttyUSB1")


def expect(what, found, wanted):
    if found != wanted:
        raise AssertionError(f"{what}: expected {wanted!r}, found {found!r}")


def expect_in(text, *parts):
    words = " ".join(text.split())  # the terminal folds lines
    for part in parts:
        if part not in words:
            raise AssertionError(f"expected {part!r} in:\n{text}")


def run(machine, port, cases=READ, more="--profile xbc-h", code=0, user="root"):
    tool = f"{RUN} {cases} --endpoint \"serial:{port}\" {more}"
    if user != "root":
        tool = f"su {user} -c '" + tool.replace("'", "") + f" --out /tmp/{user}'"
    command = f"{tool} >/tmp/run.log 2>&1; code=$?; cat /tmp/run.log; (exit $code)"
    text, found = machine.run(command, check=False)
    if found != code:
        raise AssertionError(f"exit code {found} instead of {code}:\n{text}")
    return text


class Emulated:
    """An emulated PLC at the other end, for as long as the block lasts."""

    def __init__(self, machine, port, model=f"xbc-h?{NOT_EXACT}"):
        self.machine, self.port, self.model = machine, port, model

    def __enter__(self):
        command = self.model if " " in self.model else f"fieldproof emulate '{self.model}' --tty {self.port}"
        self.machine.start(command)
        self.machine.run("while ! [ -s /tmp/background.log ]; do usleep 50000; done; cat /tmp/background.log")

    def __exit__(self, *_):
        self.machine.run("killall -q fieldproof xgt_cnet_broken_server; while pidof fieldproof xgt_cnet_broken_server; do "
                         "usleep 20000; done >/dev/null", check=False)


# ---- what must hold

def every_setting_carries_a_run(machine):
    """All 96, on both drivers side by side. Who sets the far port, and reads what ours was set to, is stty."""
    unhurried = "xbc-h?inter_character_floor_ms=300"
    machine.uarts.bits = machine.adapters.bits = 12  # as many as any of them has
    try:
        with Emulated(machine, UARTS[1], unhurried), Emulated(machine, ADAPTERS[1], unhurried):
            for ports in (UARTS, ADAPTERS):
                start_matrix(machine, *ports)
            for port, _ in (UARTS, ADAPTERS):
                expect_each_setting(machine, port)
    finally:
        machine.uarts.bits = machine.adapters.bits = 10


def start_matrix(machine, port, far):
    name = Path(port).name
    machine.run(f"({RUN} {ONE} --profile xbc-h --floor 100ms --endpoint serial:{port} --matrix all --out /tmp/{name} "
                f"--reconfigure 'reconfigure {port} {far}' >/tmp/{name}.log 2>&1; echo code $? >>/tmp/{name}.log) &")


def expect_each_setting(machine, port):
    name = Path(port).name
    text = machine.run(f"while ! grep -q ^code /tmp/{name}.log; do usleep 200000; done; cat /tmp/{name}.log", 300)
    expect_in(text, "96 cases", "96 PASS", "code 0")
    seen = machine.run(f"stty -a -F {port} 2>/dev/null >>/tmp/{name}.settings; cat /tmp/{name}.settings")
    expect(f"settings of {port}", [words_of(one) for one in seen.split("speed ")[2:]],
           [words_of(f"{speed} {PARITIES[frame[1]]} cs{frame[0]} {'-' if frame[2] == '1' else ''}cstopb")
            for speed, frame in SETTINGS])


def words_of(setting):
    """Of what stty prints, what a line setting is."""
    return re.findall(r"(?<!\S)(?:\d+(?=\s)|-?parenb|-?parodd|cs\d|-?cstopb)(?!\S)", setting)


def another_speed_is_named_and_no_verdict(machine):
    with Emulated(machine, UARTS[1], f"xbc-h?line=19200-8N1&{NOT_EXACT}"):
        expect_in(run(machine, UARTS[0], FEW, code=3), "nothing answers on serial:/dev/ttyS1 9600-8N1", "speed")


def a_case_may_want_the_line_that_the_port_has(machine):
    with Emulated(machine, UARTS[1]):
        text, _ = machine.run(f"fieldproof run --profile xbc-h --role server --filter 'xgt_cnet/line/*' --endpoint "
                              f"serial:{UARTS[0]} --dry-run 2>&1", check=False)
        expect("cases that want 9600-8N1 are not turned away", "line = 9600-8N1" in text, False)


def a_fifo_is_told_to_hand_over_at_once(machine):
    file = "/sys/class/tty/ttyS1/rx_trig_bytes"
    machine.run(f"stty 9600 -F {UARTS[0]}; echo 8 >{file}")  # the kernel itself sets 1 below 2400 bit/s
    with Emulated(machine, UARTS[1]):
        expect_in(run(machine, UARTS[0]), "silence inside a reply from 2.0 ms (rx_trig_bytes 1 for this run, else 8)")
    expect("put back", machine.run(f"cat {file}").split(), ["8"])


def a_timer_is_told_to_be_short(machine):
    file = "/sys/class/tty/ttyUSB0/device/latency_timer"
    machine.run(f"echo 16 > {file}")
    with Emulated(machine, ADAPTERS[1]):
        expect_in(run(machine, ADAPTERS[0]), "latency_timer 1 for this run, else 16")
    expect("put back", machine.run(f"cat {file}").split(), ["16"])


def a_fifo_that_gathers_is_no_fault_of_the_device(machine):
    """Eight bytes at once, and four characters of silence before the last: 3 ms cannot be shown at 9600."""
    machine.run("mount -o remount,ro /sys")
    try:
        with Emulated(machine, UARTS[1]):
            text = run(machine, UARTS[0], more="--profile /tmp/short_gap.json", code=4)
            expect_in(text, "rx_trig_bytes 8, which root can set to 1", "3 INCONCLUSIVE",
                      "this link may make 6.2 ms itself")
    finally:
        machine.run("mount -o remount,rw /sys")


def a_split_answer_is_a_fault_all_the_same(machine):
    with Emulated(machine, UARTS[1], f"xgt_cnet_broken_server split_answer {UARTS[1]}"):
        expect_in(run(machine, UARTS[0], FEW, code=1), "split answer")


def a_line_without_pace_has_no_wire(machine):
    machine.uarts.paced = False
    try:
        with Emulated(machine, UARTS[1]):
            expect_in(run(machine, UARTS[0]), "no wire: answers came up to")
    finally:
        machine.uarts.paced = True


def a_stray_answer_is_noticed_and_the_next_ones_brought_in_step(machine):
    with Emulated(machine, UARTS[1]):
        machine.uarts.again(4)
        expect_in(run(machine, UARTS[0]), "answers were one request behind, and were brought in step again", "exit 0")


def a_lost_answer_while_preparing_fails_nothing(machine):
    """Of the answers behind the first probes, one after the other is lost."""
    with Emulated(machine, UARTS[1]):
        for lost in (23, 24):
            machine.uarts.lose(lost)
            expect_in(run(machine, UARTS[0], FEW), "exit 0")
            expect(f"answer {lost} was lost on its way", machine.uarts.lost(), True)


def who_holds_a_port_is_named(machine):
    machine.run(f"cat {UARTS[0]} >/dev/null & echo $! >/tmp/reader; usleep 200000")
    expect_in(run(machine, UARTS[0], code=3), "the port is in use by process", "(cat)")
    machine.run("kill $(cat /tmp/reader)")
    with Emulated(machine, UARTS[1]):
        expect_in(run(machine, UARTS[1], code=3), "the port is in use by process", "(fieldproof)")
        text, code = machine.run(f"fieldproof emulate xbc-h --tty {UARTS[1]} 2>&1", check=False)
        expect("exit code", code, 3)
        expect_in(text, "the port is in use by process")


def as_udev_has_it(machine):
    machine.run(f"chgrp dialout {' '.join(UARTS + ADAPTERS)}; chmod 660 {' '.join(UARTS + ADAPTERS)}")


def without_root_a_port_wants_its_group(machine):
    as_udev_has_it(machine)
    text = run(machine, UARTS[0], code=3, user="stranger")
    expect_in(text, f"cannot open {UARTS[0]}: permission denied; add yourself to the group dialout")


def without_root_is_set_what_the_driver_lets_one_set(machine):
    as_udev_has_it(machine)
    trigger, timer = "/sys/class/tty/ttyS1/rx_trig_bytes", "/sys/class/tty/ttyUSB0/device/latency_timer"
    machine.run(f"stty 9600 -F {UARTS[0]}; echo 8 >{trigger}; echo 16 >{timer}")
    with Emulated(machine, UARTS[1]):
        expect_in(run(machine, UARTS[0], user="member"), "rx_trig_bytes 8, which root can set to 1", "3 PASS")
    with Emulated(machine, ADAPTERS[1]):  # low_latency shortens its timer
        expect_in(run(machine, ADAPTERS[0], user="member"), "latency_timer 1 for this run, else 16", "3 PASS")
    expect("as before", machine.run(f"cat {trigger} {timer}").split(), ["8", "16"])


def without_root_who_holds_a_port_is_named_too(machine):
    as_udev_has_it(machine)
    with Emulated(machine, UARTS[1]):
        expect_in(run(machine, UARTS[1], code=3, user="member"), "the port is in use by process", "(fieldproof) since")
        machine.run("rm /var/lock/LCK*")  # as of a program that keeps none
        expect_in(run(machine, UARTS[1], code=3, user="member"), "the port is in use by process", "(fieldproof); end that")


def what_a_killed_run_left_set_is_put_back_by_the_next(machine):
    for ports, file, value in ((UARTS, "/sys/class/tty/ttyS1/rx_trig_bytes", "8"),
                               (ADAPTERS, "/sys/class/tty/ttyUSB0/device/latency_timer", "16")):
        machine.run(f"stty 9600 -F {ports[0]}; echo {value} >{file}")
        with Emulated(machine, ports[1]):
            machine.run(f"{RUN} {READ} --profile xbc-h --duration 1h --endpoint serial:{ports[0]} >/tmp/killed.log 2>&1 & killed=$!; "
                        f"while [ $(cat {file}) != 1 ]; do usleep 20000; done; usleep 300000; kill -9 $killed; wait $killed; true")
            expect("a killed run leaves it", machine.run(f"cat {file}").split(), ["1"])
            expect_in(run(machine, ports[0]), f"{file.rpartition('/')[2]} 1 for this run, else {value}")
        expect("put back by the next", machine.run(f"cat {file}").split(), [value])


def a_driver_without_rs485_is_switched_by_rts(machine):
    for ports in (UARTS, ADAPTERS):
        expect_in(run(machine, f"{ports[0]}?rs485=1", code=3), "its driver has no RS-485 mode; use rs485=rts")
        with Emulated(machine, ports[1]):
            expect_in(run(machine, f"{ports[0]}?rs485=rts", FEW), "1 PASS")


def a_name_without_a_uart_is_absent(machine):
    expect_in(run(machine, "/dev/ttyS3", code=3), "there is no UART behind this name")
    run(machine, "/dev/ttyS3", more="--profile xbc-h --skip-absent", code=77)


def pty_is_for_ptys(machine):
    text, code = machine.run(f"fieldproof emulate xbc-h --pty {UARTS[1]} 2>&1", check=False)
    expect("exit code", code, 3)
    expect_in(text, f"it is a real port; write --tty {UARTS[1]}")


def a_served_port_ends_a_frame_by_the_silence_of_its_line(machine):
    """3.5 characters are 4 ms at 9600; behind a pty an emulated device waits for 20."""
    with Emulated(machine, UARTS[1], "xbc-h?protocol=modbus-rtu"):
        text = run(machine, f"{UARTS[0]}?protocol=modbus-rtu", "modbus_rtu/examples/read_coil_status")
        fastest = float(re.search(r"\(\d+ answers [^:]*: min (-?[\d.]+)", " ".join(text.split()))[1])
        expect(f"the fastest of 20 answers, after {fastest} ms, is one of a UART", fastest < 20, True)


def an_adapter_that_was_pulled_out_is_restored(machine):
    with Emulated(machine, ADAPTERS[1], f"xbc-h?line=1200-8N1&{NOT_EXACT}"):
        machine.run("rm -rf /tmp/out")
        machine.run(f"({RUN} 'xgt_cnet/wss/*' --profile xbc-h --endpoint 'serial:{ADAPTERS[0]}?baud=1200' --out /tmp/out "
                    ">/tmp/run.log 2>&1; echo code $? >>/tmp/run.log) & "
                    "while ! grep -qs '\"saved\"' /tmp/out/journal.ndjson; do usleep 20000; done")
        machine.unplug(0)
        text = machine.run("while ! grep -q '^code' /tmp/run.log; do usleep 50000; done; cat /tmp/run.log")
        expect_in(text, "code 3", "fieldproof restore")
        text, code = machine.run("fieldproof restore /tmp/out/journal.ndjson 2>&1", check=False)
        expect("nothing is there yet", code, 3)
        expect_in(text, "where it came back under another name, add --endpoint 'serial:/dev/NAME?baud=1200'")
        machine.plug(0)
        name = re.findall(r"ttyUSB\d+", machine.run("ls /dev/ttyUSB*"))[0]
        expect_in(machine.run(f"fieldproof restore /tmp/out/journal.ndjson --endpoint 'serial:/dev/{name}?baud=1200' 2>&1"), "restored")


TESTS = [every_setting_carries_a_run, another_speed_is_named_and_no_verdict, a_case_may_want_the_line_that_the_port_has,
         a_fifo_is_told_to_hand_over_at_once, a_timer_is_told_to_be_short, a_fifo_that_gathers_is_no_fault_of_the_device,
         a_split_answer_is_a_fault_all_the_same, a_line_without_pace_has_no_wire,
         a_stray_answer_is_noticed_and_the_next_ones_brought_in_step, a_lost_answer_while_preparing_fails_nothing,
         who_holds_a_port_is_named, without_root_a_port_wants_its_group,
         without_root_is_set_what_the_driver_lets_one_set, without_root_who_holds_a_port_is_named_too,
         what_a_killed_run_left_set_is_put_back_by_the_next, a_driver_without_rs485_is_switched_by_rts,
         a_name_without_a_uart_is_absent, pty_is_for_ptys,
         a_served_port_ends_a_frame_by_the_silence_of_its_line, an_adapter_that_was_pulled_out_is_restored]


def image(folder, kernel, programs):
    files = Files(folder / "root")
    files.add_system(kernel)
    for program in programs:
        files.add_program(program, f"/usr/bin/{Path(program).name}")
    files.add(SOURCE / "vectors", "/usr/share/fieldproof/vectors")
    files.add(SOURCE / "suites/profiles", "/usr/share/fieldproof/profiles")
    files.add(SOURCE / "suites/user_frames/definitions", "/usr/share/fieldproof/definitions")
    files.write("/usr/bin/reconfigure", RECONFIGURE)
    files.write("/etc/group", "root:x:0:\ndialout:x:20:member\nmember:x:1000:\nstranger:x:1001:\n")
    files.write("/etc/passwd", "root:x:0:0::/root:/bin/sh\n" + "".join(
        f"{name}:x:{number}:{number}::/tmp:/bin/sh\n" for name, number in (("member", 1000), ("stranger", 1001))))
    profile = {"name": "short-gap", "extends": "xbc-h", "timing": {"max_gap": "3ms"}}
    files.write("/tmp/short_gap.json", json.dumps(profile))
    files.pack(folder / "image")
    return folder / "image"


def main(arguments):
    if len(arguments) < 2:
        print(__doc__)
        return 2
    if missing := missing_programs():
        print(f"skipped: {', '.join(missing)} missing", file=sys.stderr)
        return SKIPPED
    chosen = [test for test in TESTS if len(arguments) < 3 or arguments[2] in test.__name__]
    failed = 0
    with tempfile.TemporaryDirectory(prefix="fieldproof-uart-") as name:
        folder = Path(name)
        kernel = fetch_kernel(SOURCE / "build" / "uart")
        begun = time.monotonic()
        with Machine(kernel, image(folder, kernel, arguments[:2]), folder) as machine:
            print(f"started in {time.monotonic() - begun:.0f} s", flush=True)
            for test in chosen:
                began = time.monotonic()
                try:
                    test(machine)
                    print(f"ok      {test.__name__}  {time.monotonic() - began:.0f} s", flush=True)
                except Exception as trouble:  # the others are tried all the same
                    failed += 1
                    print(f"FAILED  {test.__name__}\n{trouble}", flush=True)
    print(f"{len(chosen) - failed} of {len(chosen)} hold, {time.monotonic() - begun:.0f} s")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
