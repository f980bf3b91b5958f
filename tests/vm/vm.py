"""A virtual machine for tests: Debian's kernel, four displays of a virtio GPU, the host's files.

Vm starts QEMU without KVM (the emulator is slower, but the same everywhere), and offers
  run(command)      runs a command in the machine's shell; returns its output once it has ended
  wait_for(regex)   the next line of the machine's console that matches; merlind's log goes there
  screendump(head)  the picture of display `head`, counted from 0
No function sleeps: each call waits for bytes, up to a deadline, and then fails with what it has received.
"""
import argparse
import glob
import json
import os
import re
import selectors
import shutil
import socket
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
HEADS = 4
DEADLINE_S = 400  # against a hang only: the machine may be busy
MODULES = ("virtio_pci", "virtio_console", "virtio-gpu", "9pnet_virtio", "9p")


class Missing(Exception):
    """Something that a virtual machine needs is not available here."""


def arguments():
    """Parses a test program's command line: its folders, and the arguments for unittest."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", required=True, help="folder of the programs")
    parser.add_argument("--work", required=True, help="folder for the machine's files")
    options, rest = parser.parse_known_args()
    options.bin, options.work = os.path.abspath(options.bin), os.path.abspath(options.work)
    return options, [sys.argv[0], "-v", *rest]


def fetch(packages, folder):
    """Downloads Debian packages into `folder`, and returns their files."""
    os.makedirs(folder, exist_ok=True)
    fetched = subprocess.run(["apt-get", "-q", "-o", "APT::Sandbox::User=root", "download", *packages],
                             cwd=folder, capture_output=True, text=True)
    if fetched.returncode:
        raise Missing(f"not fetched: {' '.join(packages)}: {fetched.stderr.strip().splitlines()[0]}")
    return glob.glob(f"{folder}/*.deb")


def kernel(cache):
    """(kernel, folder of modules) of Debian's stock kernel, unpacked from its package into `cache`."""
    if not glob.glob(f"{cache}/boot/vmlinuz-*"):
        depends = subprocess.run(["apt-cache", "depends", "linux-image-amd64"], capture_output=True, text=True)
        named = re.search(r"Depends: (linux-image-\S+)", depends.stdout)
        if not named:
            raise Missing("apt knows no package linux-image-amd64; is `apt-get update` needed?")
        [package] = fetch([named[1]], cache)
        subprocess.run(["dpkg-deb", "-x", package, cache], check=True)
        os.unlink(package)
    return glob.glob(f"{cache}/boot/vmlinuz-*")[0], glob.glob(f"{cache}/lib/modules/*")[0]


def module_files(folder, wanted):
    """Files of the modules `wanted` and of those that they need, in the order in which they have to be loaded.

    `wanted`: names of modules in `folder`, or paths of other modules.
    """
    paths = glob.glob(f"{folder}/**/*.ko", recursive=True) + [name for name in wanted if "/" in name]
    files = {os.path.basename(path)[:-3].replace("-", "_"): path for path in paths}
    order = []

    def add(name):
        path = files.get(name.replace("-", "_"))
        if path is None:
            return  # built into the kernel
        if path in order:
            return
        with open(path, "rb") as file:
            needs = re.search(rb"\0depends=([^\0]*)\0", file.read())
        for needed in needs[1].decode().split(",") if needs and needs[1] else ():
            add(needed)
        order.append(path)

    for name in wanted:
        add(os.path.basename(name).removesuffix(".ko"))
    return order


def initrd(path, modules, init):
    """Writes the machine's first files: busybox, modules, guest/`init` (a cpio archive, format newc)."""
    def entry(name, mode, data=b""):
        name = name.encode() + b"\0"
        fields = (entry.count, mode, 0, 0, 1, 0, len(data), 0, 0, 0, 0, len(name), 0)
        entry.count += 1
        head = b"070701" + b"".join(b"%08X" % f for f in fields) + name
        return head + b"\0" * (-len(head) % 4) + data + b"\0" * (-len(data) % 4)

    entry.count = 1
    busybox = next((p for p in ("/bin/busybox", "/usr/bin/busybox") if os.path.exists(p)), None)
    if busybox is None:
        raise Missing("busybox is not there (package busybox-static)")
    def content(source):
        with open(source, "rb") as file:
            return file.read()

    archive = b"".join(entry(d, 0o040755) for d in ("bin", "dev", "host", "modules"))
    names = []
    for module in modules:
        names.append(os.path.basename(module)[:-3])
        archive += entry("modules/" + os.path.basename(module), 0o100644, content(module))
    archive += entry("modules/order", 0o100644, "\n".join(names).encode())
    archive += entry("bin/busybox", 0o100755, content(busybox))
    archive += entry("init", 0o100755, content(f"{HERE}/guest/{init}"))
    archive += entry("TRAILER!!!", 0)
    with open(path, "wb") as file:
        file.write(archive)


def until(condition, what, deadline_s=DEADLINE_S):
    """Calls the condition repeatedly until it returns a true value; returns that value."""
    end = time.monotonic() + deadline_s
    while not (result := condition()):
        if time.monotonic() > end:
            raise AssertionError(f"not within {deadline_s} s: {what}")
    return result


class Line:
    """A stream socket, whose bytes are read until an expected text comes."""

    def __init__(self, path, ended):
        self.socket = socket.socket(socket.AF_UNIX)
        self.ended, self.seen, self.at = ended, b"", 0
        self.log = open(path + ".log", "wb")
        until = time.monotonic() + DEADLINE_S
        while True:  # QEMU makes the socket a moment after it has started
            try:
                self.socket.connect(path)
                break
            except OSError:
                if time.monotonic() > until or ended():
                    raise
                time.sleep(0.02)
        self.selector = selectors.DefaultSelector()
        self.selector.register(self.socket, selectors.EVENT_READ)

    def close(self):
        self.selector.close()
        self.socket.close()
        self.log.close()

    def send(self, text):
        self.socket.sendall(text.encode())

    def wait_for(self, regex, deadline_s=DEADLINE_S):
        """The next match after the last one; AssertionError with the received text if there is none."""
        pattern, until = re.compile(regex.encode(), re.MULTILINE), time.monotonic() + deadline_s
        while True:
            # Searches only whole lines, since a line may arrive in pieces.
            found = pattern.search(self.seen, self.at, self.seen.rfind(b"\n") + 1)
            if found:
                self.at = found.end()
                return found
            left = until - time.monotonic()
            data = self.socket.recv(65536) if left > 0 and self.selector.select(left) else b""
            if not data:
                raise AssertionError(f"no {regex!r} within {deadline_s} s"
                                     f"{' (QEMU has ended)' if self.ended() else ''}; what came:\n"
                                     + self.seen[self.at:].decode(errors="replace")[-4000:])
            self.seen += data
            self.log.write(data)
            self.log.flush()


    def wait_for_all(self, regexes, deadline_s=DEADLINE_S):
        """The matches of several regular expressions, in any order."""
        begin, found, end = self.at, [], self.at
        for regex in regexes:
            self.at = begin
            found.append(self.wait_for(regex, deadline_s))
            end = max(end, self.at)
        self.at = end
        return found


class Vm:
    def __init__(self, folder, mode, memory_mb=1536, root=None, modules=(), extra=()):
        """`folder`: for the machine's files; FOLDER/shared is its /mnt. `mode`: for example "640x480".

        `modules`: names of further modules of the kernel, or paths of others. `extra`: arguments of QEMU; a further
        serial port is /dev/ttyS1.

        `root`: a folder with a Debian of its own with systemd, which the machine may change; None: the host's root,
        read-only.
        """
        self.folder, self.shared = folder, os.path.join(folder, "shared")
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(self.shared)
        if shutil.which("qemu-system-x86_64") is None:
            raise Missing("QEMU is not there (package qemu-system-x86)")
        vmlinuz, module_folder = kernel(os.path.join(os.path.dirname(folder), "kernel"))
        initrd(f"{folder}/initrd", module_files(module_folder, MODULES + tuple(modules)), "systemd" if root else "init")
        # Files keep their owners, which only root can set.
        owners = "passthrough" if os.geteuid() == 0 else "none"
        shares = f"path={root},security_model={owners}" if root else "path=/,security_model=none,readonly=on"
        video = " ".join(f"video=Virtual-{i + 1}:{mode}@60e" for i in range(HEADS))
        self.log = open(f"{folder}/qemu.log", "wb")
        self.qemu = subprocess.Popen(
            ["qemu-system-x86_64", "-machine", "q35,accel=tcg", "-cpu", "max", "-smp", "2", "-m", str(memory_mb),
             "-nodefaults", "-vga", "none", "-display", "none", "-no-reboot",
             "-device", f"virtio-gpu-pci,id=gpu,max_outputs={HEADS}",
             "-kernel", vmlinuz, "-initrd", f"{folder}/initrd",
             "-append", f"console=ttyS0 quiet panic=-1 vt.global_cursor_default=0 consoleblank=0 {video}",
             "-chardev", f"socket,id=console,path={folder}/console,server=on,wait=on", "-serial", "chardev:console",
             "-device", "virtio-serial-pci",
             "-chardev", f"socket,id=shell,path={folder}/shell,server=on,wait=off",
             "-device", "virtserialport,chardev=shell,name=merlin.shell",
             "-virtfs", f"local,{shares},mount_tag=host,multidevs=remap",
             "-virtfs", f"local,path={self.shared},mount_tag=out,security_model=none",
             "-qmp", f"unix:{folder}/qmp,server=on,wait=off", *extra],
            stdin=subprocess.DEVNULL, stdout=self.log, stderr=subprocess.STDOUT)
        ended = lambda: self.qemu.poll() is not None
        self.console = Line(f"{folder}/console", ended)
        self.shell, self.monitor = Line(f"{folder}/shell", ended), Line(f"{folder}/qmp", ended)
        self.monitor.send('{"execute": "qmp_capabilities"}')
        self.monitor.wait_for(r'"return"')
        self.console.wait_for("init: ready")
        self.commands = 0

    def wait_for(self, regex, deadline_s=DEADLINE_S):
        return self.console.wait_for(regex, deadline_s)[0].decode(errors="replace")

    def wait_for_all(self, *regexes):
        return [found[0].decode(errors="replace") for found in self.console.wait_for_all(regexes)]

    def run(self, command, succeeds=True):
        """Runs a command; returns its output and error output. AssertionError if it fails and `succeeds` is true."""
        self.commands += 1
        mark = f"@{self.commands}@"
        begin = len(self.shell.seen)
        self.shell.send(f"{{ {command}\n}} </dev/null; echo \"{mark}$?\"\n")
        found = self.shell.wait_for(re.escape(mark) + r"(\d+)\r?\n")
        output = self.shell.seen[begin:found.start()].decode(errors="replace")
        if succeeds and int(found[1]):
            raise AssertionError(f"{command!r} ended with {int(found[1])}:\n{output}")
        return output

    def ask(self, command, **arguments):
        """Runs a command of QEMU's monitor."""
        self.monitor.send(json.dumps({"execute": command, "arguments": arguments}))
        answer = self.monitor.wait_for(r'"(return|error)".*')
        if answer[1] == b"error":
            raise AssertionError(answer[0].decode())

    def screendump(self, head):
        """(width, height, RGB bytes) of the picture that a display shows."""
        path = f"{self.folder}/head{head}.ppm"
        self.ask("screendump", filename=path, device="gpu", head=head)
        with open(path, "rb") as file:
            data = file.read()
        header = re.match(rb"P6\s(\d+) (\d+)\s255\s", data)
        return int(header[1]), int(header[2]), data[header.end():]

    def close(self):
        self.qemu.kill()
        self.qemu.wait()
        for line in (self.console, self.shell, self.monitor):
            line.close()
        self.log.close()
