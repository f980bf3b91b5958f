"""Modules that Debian's kernel leaves out, for the virtual machine: a simulated GPIO chip, and a display with CRCs.

build() makes them once, out of tree, of Debian's source for exactly the machine's kernel, and keeps
them in WORK/modules/RELEASE. To see by hand whether they can be built on this machine:

    python3 -B tests/vm/modules.py build/vm
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import vm

# The files and folders of the kernel's source that each module needs.
GPIO_SIM, VKMS = "gpio-sim", "vkms"
SOURCES = {GPIO_SIM: ("drivers/gpio/gpio-sim.c", "drivers/gpio/gpiolib.h", "kernel/irq/irq_sim.c"),
           VKMS: ("drivers/gpu/drm/vkms",)}
DOWNLOAD_MB = 155  # for both modules together


def build(work, name):
    """The path of a module's file, which is built if it does not exist yet; raises vm.Missing if that is not
    possible."""
    cache = f"{work}/kernel"
    release = os.path.basename(vm.kernel(cache)[1])
    folder = f"{work}/modules/{release}"
    made = f"{folder}/{name}.ko"
    if os.path.exists(made):
        return made
    for program in ("gcc", "make", "xz"):
        if shutil.which(program) is None:
            raise vm.Missing(f"the module {name} is not built: {program} is not there")
    os.makedirs(folder, exist_ok=True)
    print(f"test-vm: builds {' and '.join(SOURCES)} for {release}, once: {DOWNLOAD_MB} MB to fetch", flush=True)
    with tempfile.TemporaryDirectory(dir=folder) as at:
        fetch(at, release, cache)
        for module, sources in SOURCES.items():
            compile_module(at, release, module, sources, f"{folder}/{module}.ko")
    return made


def fetch(at, release, cache):
    """Unpacks the headers for this kernel into AT/usr, and the needed files of its source into AT/source."""
    headers = f"linux-headers-{release}"
    series = re.match(r"\d+\.\d+", release)[0]
    policy = subprocess.run(["apt-cache", "policy", headers], capture_output=True, text=True)
    version = re.search(r"Candidate: (\d\S*)", policy.stdout)
    if not version:
        raise vm.Missing(f"apt knows no package {headers}; if {cache} has a kernel that Debian has replaced, remove it")
    packages = {name: f"{name}={version[1]}" for name in
                (headers, re.sub(r"[a-z0-9]+$", "common", headers), f"linux-kbuild-{series}", f"linux-source-{series}")}
    files = vm.fetch(packages.values(), at)
    source = next(file for file in files if "linux-source" in file)
    for file in files:
        if file != source:
            subprocess.run(["dpkg-deb", "-x", file, at], check=True)
    # The header package refers to its other half by the path at which that would be installed.
    makefile = f"{at}/usr/src/{headers}/Makefile"
    with open(makefile, encoding="utf-8") as file:
        text = file.read()
    with open(makefile, "w", encoding="utf-8") as file:
        file.write(text.replace("include /usr/src/", f"include {at}/usr/src/"))
    # The package is an archive that contains the compressed archive of the source.
    tree = f"linux-source-{series}"
    wanted = " ".join(f"{tree}/{path}" for paths in SOURCES.values() for path in paths)
    os.makedirs(f"{at}/source")
    subprocess.run(f"dpkg-deb --fsys-tarfile {source} | tar -xO ./usr/src/{tree}.tar.xz"
                   f" | tar -xJ -C {at}/source --strip-components=1 {wanted}", shell=True, check=True)
    os.unlink(source)


def compile_module(at, release, name, sources, made):
    """Builds one module. All that it needs is available, so a failure is an error."""
    folder = f"{at}/{name}"
    os.makedirs(folder)
    for source in (f"{at}/source/{path}" for path in sources):
        if os.path.isdir(source):
            shutil.copytree(source, folder, dirs_exist_ok=True)
        else:
            shutil.copy(source, folder)
    if name == GPIO_SIM:
        add_interrupts(folder)
    done = subprocess.run(["make", "-C", f"{at}/usr/src/linux-headers-{release}", f"M={folder}", f"-j{os.cpu_count()}",
                           "CONFIG_DRM_VKMS=m", "modules"], capture_output=True, text=True)
    if done.returncode:
        raise AssertionError(f"the module {name} was not built:\n{done.stdout[-4000:]}{done.stderr[-4000:]}")
    shutil.move(f"{folder}/{name}.ko", made)


def add_interrupts(folder):
    """Makes one module of gpio-sim and irq_sim (CONFIG_IRQ_SIM), since Debian's kernel has neither."""
    os.rename(f"{folder}/gpio-sim.c", f"{folder}/chip.c")  # a module of two files needs a name that differs from theirs
    with open(f"{folder}/Makefile", "w", encoding="utf-8") as file:
        file.write("obj-m := gpio-sim.o\ngpio-sim-y := chip.o irq_sim.o\n")
    with open(f"{folder}/irq_sim.c", encoding="utf-8") as file:
        text = file.read()
    # Modules may not use irq_to_desc(); generic_handle_irq() calls the same handler, which irq_sim.c has set.
    with open(f"{folder}/irq_sim.c", "w", encoding="utf-8") as file:
        file.write(text.replace("handle_simple_irq(irq_to_desc(irqnum))", "generic_handle_irq(irqnum)"))


def build_or_skip(work, name, what):
    """As build(), for the module of a test; if it cannot be built, the tests of `what` are skipped with the
    reason."""
    try:
        return build(work, name)
    except vm.Missing as missing:
        print(f"test-vm: {what} is skipped: {missing}")
        raise unittest.SkipTest(str(missing)) from missing


if __name__ == "__main__":
    try:
        for wanted in SOURCES:
            print(build(os.path.abspath(sys.argv[1]), wanted))
    except vm.Missing as missing:
        sys.exit(str(missing))
