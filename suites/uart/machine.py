"""A small virtual machine with real UART drivers: the kernel of Debian, busybox and fieldproof, started from memory.

Two 8250 ports (/dev/ttyS1, /dev/ttyS2) are the ends of one paced line, two FTDI adapters (/dev/ttyUSB0, /dev/ttyUSB1) those of
another; one adapter can be pulled out. Commands run in its shell, over its console. Needs no KVM.
"""
import glob
import json
import os
import pathlib
import re
import shutil
import socket
import subprocess
import tempfile
import time

from paced_line import PacedLine

MODULES = ["usb-common", "usbcore", "xhci-hcd", "xhci-pci", "usbserial", "ftdi_sio"]
INIT = """#!/bin/busybox sh
/bin/busybox --install -s /bin
mkdir -p /proc /sys /dev /tmp /root; mount -t proc none /proc; mount -t sysfs none /sys; mount -t devtmpfs none /dev; mkdir -p /dev/pts /dev/shm /run /var/lock /tmp
mount -t devpts none /dev/pts; chmod 1777 /tmp /var/lock
for m in %s; do insmod /modules/$m.ko; done
export HOME=/root TERM=dumb
exec 3<>/dev/ttyS0  # open from here on: what comes to a port that nobody has open is lost
stty -echo <&3
echo MACHINE-IS-READY >&3
# Not on a terminal, where it would take the end of a background process for that of its input.
sh <&3 2>&1 | cat >&3
"""


def missing_programs():
    return [name for name in ("qemu-system-x86_64", "busybox", "cpio") if not shutil.which(name)]


def fetch_kernel(folder):
    """The folder of a kernel package, unpacked; fetched once."""
    if not (folder / "kernel").is_dir():
        folder.mkdir(parents=True, exist_ok=True)
        depends = subprocess.run(["apt-cache", "depends", "linux-image-amd64"], capture_output=True, text=True, check=True).stdout
        name = re.search(r"linux-image-[0-9]\S*", depends)[0]
        subprocess.run(["apt-get", "download", "-qq", name], cwd=folder, check=True, stderr=subprocess.DEVNULL)
        [package] = folder.glob("*.deb")
        subprocess.run(["dpkg-deb", "-x", package, folder / "unpacked"], check=True)
        package.unlink()
        (folder / "unpacked").rename(folder / "kernel")
    return folder / "kernel"


class Failed(Exception):
    """What a command of the machine did that it should not."""


def libraries(program):
    """The files that the dynamic linker loads for it."""
    text = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
    return [pathlib.Path(path) for path in re.findall(r"(/\S+) \(0x", text)]


class Files:
    """What the machine starts from: a folder, packed at the end."""

    def __init__(self, folder):
        self.root = pathlib.Path(folder)

    def add(self, source, target, mode=0o755):
        path = self.root / target.lstrip("/")
        path.parent.mkdir(parents=True, exist_ok=True)
        if pathlib.Path(source).is_dir():
            shutil.copytree(source, path)
        else:
            shutil.copyfile(source, path)
            path.chmod(mode)

    def add_system(self, kernel):
        self.add(shutil.which("busybox"), "/bin/busybox")
        for name in MODULES:
            [file] = kernel.rglob(name + ".ko")
            self.add(file, f"/modules/{name}.ko")
        self.write("/init", INIT % " ".join(MODULES))

    def add_program(self, source, target):
        self.add(source, target)
        for library in libraries(source):
            self.add(library.resolve(), str(library))

    def write(self, target, text):
        path = self.root / target.lstrip("/")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        path.chmod(0o755)

    def pack(self, image):
        names = subprocess.run(["find", "."], cwd=self.root, capture_output=True, check=True).stdout
        with open(image, "wb") as file:
            subprocess.run(["cpio", "-o", "-H", "newc", "--quiet"], cwd=self.root, input=names, stdout=file, check=True)


def be_in_time():
    """A line does not wait for a busy machine. Without permission the test is what it can be."""
    try:
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(1))
    except PermissionError:
        pass


class Machine:
    def __init__(self, kernel, image, folder):
        be_in_time()  # what is started from here is, too
        self.uarts, self.adapters = PacedLine(), PacedLine()
        command = ["qemu-system-x86_64", "-accel", "tcg", "-m", "768", "-nographic",
                   "-no-reboot", "-nodefaults", "-kernel", glob.glob(f"{kernel}/boot/vmlinuz*")[0], "-initrd", str(image),
                   "-append", "console=ttyS0 quiet panic=-1 8250.nr_uarts=4 mitigations=off",
                   "-chardev", f"socket,id=console,path={folder}/console,server=on,wait=off",
                   "-qmp", f"unix:{folder}/monitor,server=on,wait=off", "-device", "isa-serial,chardev=console", "-device", "qemu-xhci"]
        for i, end in enumerate(self.uarts.ends):
            command += ["-chardev", f"serial,id=uart{i},path={end.path}", "-device", f"isa-serial,chardev=uart{i}"]
        for i, end in enumerate(self.adapters.ends):
            command += ["-chardev", f"serial,id=usb{i},path={end.path}"]
        self._process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            self._begin(folder)
        except BaseException:
            self.close()
            raise

    def _begin(self, folder):
        self._console = self._connect(folder / "console")
        self._monitor = self._connect(folder / "monitor").makefile("rw")
        self._monitor.readline()
        self._ask("qmp_capabilities")
        self._seen = b""
        self._until(b"MACHINE-IS-READY", 120)
        for i in range(len(self.adapters.ends)):
            self.plug(i)

    def _connect(self, path):
        end = time.monotonic() + 30
        while True:
            one = socket.socket(socket.AF_UNIX)
            try:
                one.connect(str(path))
                return one
            except OSError:
                one.close()
                if time.monotonic() > end or self._process.poll() is not None:
                    raise
                time.sleep(0.05)

    def _ask(self, command, **arguments):
        self._monitor.write(json.dumps({"execute": command, "arguments": arguments}) + "\n")
        self._monitor.flush()
        while True:
            answer = json.loads(self._monitor.readline())
            if "error" in answer:
                raise Failed(f"{command}: {answer['error']}")
            if "return" in answer:
                return answer["return"]

    def plug(self, adapter):
        self._ask("device_add", driver="usb-serial", id=f"adapter{adapter}", chardev=f"usb{adapter}")
        self.run(f"while ! [ -e /dev/ttyUSB{adapter} ]; do usleep 20000; done")

    def unplug(self, adapter):
        self._ask("device_del", id=f"adapter{adapter}")

    def _until(self, mark, limit):
        end = time.monotonic() + limit
        while mark not in self._seen:
            left = end - time.monotonic()
            if left <= 0 or self._process.poll() is not None:
                raise Failed(f"the machine does not answer:\n{self._seen.decode(errors='replace')}")
            self._console.settimeout(left)
            try:
                data = self._console.recv(65536)
            except TimeoutError:
                data = b""
            self._seen += data
        before, self._seen = self._seen.split(mark, 1)
        return before.decode(errors="replace").replace("\r", "")

    def start(self, command):
        """In the background; its output goes to /tmp/background.log, which is empty until it says something."""
        self.run(f"({command}) >/tmp/background.log 2>&1 &")

    def run(self, command, limit=60, check=True):
        """What the command printed. Its exit code is not 0: Failed, or both are returned where not `check`."""
        self._console.sendall(f"{{ {command}\n}} </dev/null\ncode=$?; echo; echo END-OF-COMMAND:$code:\n".replace("END-OF", 'END""-OF').encode())
        try:
            text = self._until(b"END-OF-COMMAND:", limit)
            code = int(self._until(b":", 10))
        except Failed as trouble:
            raise Failed(f"{trouble}\nin: {command}") from None
        if not check:
            return text, code
        if code != 0:
            raise Failed(f"exit code {code} of: {command}\n{text}")
        return text

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self._process.kill()
        self._process.wait()
        self.uarts.close()
        self.adapters.close()
