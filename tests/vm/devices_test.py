#!/usr/bin/env python3
"""Devices on real lines of the kernel, in a virtual machine: ./dev test-vm

Two serial ports and a serial adapter on USB, whose other ends are the emulators on the host, test the way
through libserialport. A gamepad, a touch frame and a mouse made by uinput test the way through libevdev.
The tests judge health, values and the order of events, but no rates and no latencies, since the machine is
emulated.
"""
import json
import os
import subprocess
import unittest

import vm

OPTIONS = None
MACHINE = None
EMULATORS = []
DEVICES = ("glove", "tracker", "ball")
DRIVERS = {"glove": "cyberglove", "tracker": "fastrak", "ball": "spaceball"}
EV_KEY, EV_REL, EV_ABS, ABS_RX, BTN_SOUTH = 1, 2, 3, 3, 304
SLOT, MT_X, MT_Y, TRACKING_ID, REL_X, BTN_LEFT = 47, 53, 54, 57, 0, 272
BALL = {"driver": "usb-serial", "id": "ball", "chardev": "ball-line"}


def setUpModule(modules=()):
    """Starts the emulators and the machine, with further modules of its kernel."""
    global MACHINE
    lines = f"{OPTIONS.work}/lines"
    os.makedirs(lines, exist_ok=True)
    for device, script in (("cyberglove", "grabbing"), ("fastrak", "turning"), ("spaceball", "turning")):
        command = [f"{OPTIONS.bin}/merlin", "emulate", device, "--link", f"{lines}/{device}", "--script", script]
        emulator = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        EMULATORS.append(emulator)
        emulator.stdout.readline()  # the emulator is ready
    extra = ["-chardev", f"serial,id=glove-line,path={lines}/cyberglove", "-serial", "chardev:glove-line",
             "-chardev", f"serial,id=tracker-line,path={lines}/fastrak", "-serial", "chardev:tracker-line",
             "-chardev", f"serial,id=ball-line,path={lines}/spaceball",
             "-device", "qemu-xhci,id=usb", "-device", "usb-serial,id=ball,chardev=ball-line"]
    try:
        MACHINE = vm.Vm(f"{OPTIONS.work}/machine", "640x480", memory_mb=512, extra=extra,
                        modules=("xhci-pci", "ftdi_sio", "uinput", "evdev", *modules))
    except vm.Missing as missing:
        tearDownModule()
        print(f"test-vm: skipped: {missing}")
        raise unittest.SkipTest(str(missing)) from missing
    except BaseException:
        tearDownModule()  # unittest does not call it then
        raise
    MACHINE.run(f"PATH=$PATH:{OPTIONS.bin} HOME=/run; export PATH HOME\n"
                "mkfifo /run/log; exec 4<>/run/log; cat <&4 >/dev/ttyS0 &\n"
                "mkfifo /run/input; exec 5<>/run/input")


def tearDownModule():
    if MACHINE:
        MACHINE.close()
    for emulator in EMULATORS:
        emulator.kill()
        emulator.wait()
        emulator.stdout.close()


def entry(name, port):
    return {"name": name, "driver": DRIVERS[name], "port": port}


def start(*devices, role="devices", **settings):
    """Starts merlind with these devices and waits until it is ready; returns its process id."""
    config = {"run_directory": "/run/merlin", "devices": list(devices), **settings}
    with open(f"{MACHINE.shared}/devices.json", "w", encoding="utf-8") as file:
        json.dump(config, file)
    pid = int(MACHINE.run(f"merlind --role {role} --config /mnt/devices.json >/run/log 2>&1 & echo $!"))
    MACHINE.wait_for(r"ready")
    return pid


def stop(pid):
    MACHINE.run(f"kill {pid}; wait {pid}", succeeds=False)


def listed():
    return json.loads(MACHINE.run("merlin devices --json"))


def configured():
    return {device["name"]: device for device in listed()["configured"]}


def health():
    return {name: device["health"] for name, device in configured().items()}


class Devices(unittest.TestCase):
    def test_1_three_devices_on_serial_lines_and_one_is_unplugged(self):
        pid = start(entry("glove", "serial:/dev/ttyS1"), entry("tracker", "serial:/dev/ttyS2"),
                    entry("ball", "serial:/dev/ttyUSB0"))
        vm.until(lambda: set(health().values()) == {"ok"}, "all three stream")
        found = configured()
        self.assertIn("CyberGlove", found["glove"]["identity"])
        self.assertIn("Fastrak", found["tracker"]["identity"])
        self.assertIn("Spaceball", found["ball"]["identity"])
        adapters = [p for p in listed()["plugged"] if p["kind"] == "serial adapter"]
        self.assertEqual([(a["port"], a["read_by"]) for a in adapters], [("serial:/dev/ttyUSB0", "ball")])
        before = {name: device["samples"] for name, device in found.items()}
        vm.until(lambda: all(d["samples"] > before[n] for n, d in configured().items()), "samples go on")

        MACHINE.ask("device_del", id="ball")
        vm.until(lambda: health()["ball"] == "absent", "the ball is seen to be gone")
        at_loss = configured()
        vm.until(lambda: all(configured()[n]["samples"] > at_loss[n]["samples"] for n in ("glove", "tracker")),
                 "the others go on")
        MACHINE.ask("device_add", **BALL)
        vm.until(lambda: health()["ball"] == "ok", "the ball is back")
        found = configured()
        self.assertEqual([found[name]["reconnects"] for name in DEVICES], [0, 0, 1])
        stop(pid)

    def test_2_a_line_that_is_taken_is_said_to_be(self):
        pid = start(entry("tracker", "serial:/dev/ttyS2"))
        vm.until(lambda: health()["tracker"] == "ok", "the tracker streams")
        said = MACHINE.run("merlin record serial:/dev/ttyS2 --seconds 1 -o /run/x.bytes", succeeds=False)
        self.assertIn("/dev/ttyS2: another device of this configuration, or another program, "
                      "holds this port", said)
        stop(pid)

    def plug(self, kind):
        """Makes an input device; returns the id of its process and the path of its file."""
        maker = int(MACHINE.run(f"rm -f /run/input.path; make_input {kind} </run/input "
                                ">/run/input.path 2>/run/log & echo $!"))
        path = vm.until(lambda: MACHINE.run("cat /run/input.path", succeeds=False).strip(), f"the {kind} is there")
        return maker, path

    def report(self, *events):
        """Makes one report of the input device, of several (type, code, value)."""
        MACHINE.run("echo " + " ".join(str(number) for event in events for number in event) + " >&5")

    def test_3_a_gamepad_is_found_read_grabbed_unplugged_and_back(self):
        pad, path = self.plug("gamepad")
        plugged = [p for p in listed()["plugged"] if p["kind"] == "gamepad"]
        self.assertEqual(len(plugged), 1)
        self.assertEqual(plugged[0]["name"], "made-up gamepad of a test")
        self.assertEqual(plugged[0]["axes"], ["x", "y", "rx", "ry"])
        self.assertIn("south", plugged[0]["keys"])
        suggested = plugged[0]["as"][0]
        self.assertEqual(suggested, {"name": "pad", "driver": "evdev", "port": f"evdev:{path}"})
        pid = start(suggested | {"name": "ball"})
        vm.until(lambda: health()["ball"] == "ok", "the gamepad streams")
        self.assertEqual(configured()["ball"]["identity"], "made-up gamepad of a test, 4 axes, 2 keys")
        self.report((EV_ABS, ABS_RX, 32767))
        self.report((EV_KEY, BTN_SOUTH, 1))
        vm.until(lambda: self.values() == (1.0, 1), "stick and button are in shared memory")
        samples = configured()["ball"]["samples"]
        vm.until(lambda: configured()["ball"]["samples"] > samples + 20, "the held stick is published again")
        said = MACHINE.run(f"merlin record evdev:{path} --device evdev --seconds 1 -o /run/x.bytes", succeeds=False)
        self.assertIn(f"{path}: another device of this configuration, or a program such as "
                      "spacenavd, has grabbed this input device", said)

        MACHINE.run(f"kill {pad}; wait {pad}", succeeds=False)
        vm.until(lambda: health()["ball"] == "absent", "the gamepad is seen to be gone")
        pad, again = self.plug("gamepad")
        self.assertEqual(again, path)
        vm.until(lambda: health()["ball"] == "ok", "the gamepad is back")
        self.report((EV_ABS, ABS_RX, -32768))
        vm.until(lambda: self.values() == (-1.0, 0), "what was pressed before is not pressed any more")
        stop(pid)
        MACHINE.run(f"kill {pad}; wait {pad}", succeeds=False)

    def test_4_two_fingers_pinch_on_a_touch_frame_that_is_unplugged(self):
        frame, path = self.plug("frame")
        plugged = [p for p in listed()["plugged"] if p["kind"] == "touch screen"]
        self.assertEqual([p["name"] for p in plugged], ["made-up frame of a test"])
        suggested = plugged[0]["as"][0]
        self.assertEqual(suggested, {"name": "touch", "driver": "touch", "port": f"evdev:{path}"})
        # One finger touches before merlind opens the frame.
        self.report((EV_ABS, SLOT, 0), (EV_ABS, TRACKING_ID, 7), (EV_ABS, MT_X, 2000), (EV_ABS, MT_Y, 2000))
        pid = start(suggested)
        vm.until(lambda: health()["touch"] == "ok", "the frame streams")
        self.assertEqual(configured()["touch"]["identity"], "made-up frame of a test, 10 fingers")
        vm.until(lambda: self.fingers() == [[0.25, 0.5]], "the finger that touched before is there")
        self.report((EV_ABS, SLOT, 1), (EV_ABS, TRACKING_ID, 8), (EV_ABS, MT_X, 6000), (EV_ABS, MT_Y, 2000))
        vm.until(lambda: self.fingers() == [[0.25, 0.5], [0.75, 0.5]], "two fingers touch")
        self.report((EV_ABS, SLOT, 0), (EV_ABS, MT_X, 3000), (EV_ABS, SLOT, 1), (EV_ABS, MT_X, 5000))
        vm.until(lambda: self.fingers() == [[0.375, 0.5], [0.625, 0.5]], "they pinch")
        self.report((EV_ABS, SLOT, 0), (EV_ABS, TRACKING_ID, -1))
        vm.until(lambda: self.fingers() == [[0.625, 0.5]], "one goes")
        MACHINE.run(f"kill {frame}; wait {frame}", succeeds=False)
        vm.until(lambda: health()["touch"] == "absent", "the frame is seen to be gone")
        frame, again = self.plug("frame")
        self.assertEqual(again, path)
        vm.until(lambda: health()["touch"] == "ok", "the frame is back")
        self.assertEqual(self.fingers(), [])
        stop(pid)
        MACHINE.run(f"kill {frame}; wait {frame}", succeeds=False)

    def test_5_a_pressed_mouse_is_a_finger(self):
        mouse, path = self.plug("mouse")
        pid = start({"name": "touch", "driver": "touch", "port": f"evdev:{path}", "touch": {"mouse_counts": 1000}})
        vm.until(lambda: health()["touch"] == "ok", "the mouse streams")
        self.report((EV_KEY, BTN_LEFT, 1))
        vm.until(lambda: self.fingers() == [[0.5, 0.5]], "it touches in the middle")
        self.report((EV_REL, 1, 250))
        vm.until(lambda: self.fingers() == [[0.5, 0.75]], "it drags")
        self.report((EV_KEY, BTN_LEFT, 0))
        vm.until(lambda: self.fingers() == [], "it goes")
        stop(pid)
        MACHINE.run(f"kill {mouse}; wait {mouse}", succeeds=False)

    def test_6_an_adapter_that_is_plugged_in_after_the_start_is_read(self):
        MACHINE.ask("device_del", id="ball")
        vm.until(lambda: "gone" in MACHINE.run("test -e /dev/ttyUSB0 || echo gone"), "the adapter is gone")
        pid = start(entry("tracker", "serial:/dev/ttyS2"), entry("ball", "serial:/dev/ttyUSB0"))
        vm.until(lambda: health() == {"tracker": "ok", "ball": "absent"}, "the ball is missed, the tracker streams")
        self.assertEqual(configured()["ball"]["samples"], 0)
        self.assertIn("/dev/ttyUSB0", configured()["ball"]["reason"])
        MACHINE.ask("device_add", **BALL)
        vm.until(lambda: health() == {"tracker": "ok", "ball": "ok"}, "the ball is read")
        samples = configured()["ball"]["samples"]
        vm.until(lambda: configured()["ball"]["samples"] > samples, "its samples go on")
        self.assertEqual(configured()["tracker"]["reconnects"], 0)
        stop(pid)

    def test_7_a_gamepad_moves_a_corner_of_an_output(self):
        pad, path = self.plug("gamepad")
        bindings = [{"input": "pad.button.1", "action": "align_corner_next"},
                    {"input": "pad.axis.ry+", "action": "align_right"}]
        with open(f"{MACHINE.shared}/triangle.ply", "w", encoding="utf-8") as file:
            file.write("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                       "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        subprocess.run([f"{OPTIONS.bin}/merlin", "mesh", "reduce", f"{MACHINE.shared}/triangle.ply",
                        "-o", f"{MACHINE.shared}/triangle.mrm"], check=True, capture_output=True)
        tiles = {"tile_width": 64, "tile_height": 48, "frame_width": 64, "frame_height": 48, "tiles": [{"name": "left"}]}
        output = {"kind": "png", "name": "left", "path": "/run/left.png", "interval_s": 86400, "tiles": [{"tile": "left"}]}
        pid = start({"name": "pad", "driver": "evdev", "port": f"evdev:{path}"}, role="all", bindings=bindings,
                    state_file="/run/state.json", wall={"model": "/mnt/triangle.mrm", "tiles": tiles, "outputs": [output]})
        vm.until(lambda: health()["pad"] == "ok", "the gamepad streams")

        def moved():
            (left,) = json.loads(MACHINE.run("merlin wall align --list --json"))["outputs"]
            return {corner: place["moved"] for corner, place in left["corners"].items() if place["moved"] != [0, 0]}

        self.assertEqual(moved(), {})
        self.report((EV_ABS, ABS_RX, 32767))
        vm.until(lambda: moved() == {"top_left": [1, 0]}, "the stick moves the corner that is selected first")
        self.report((EV_ABS, ABS_RX, 0))
        self.report((EV_KEY, BTN_SOUTH, 1))
        self.report((EV_KEY, BTN_SOUTH, 0))
        self.report((EV_ABS, ABS_RX, 32767))
        vm.until(lambda: moved() == {"top_left": [1, 0], "top_right": [1, 0]}, "the button selects the next corner")
        stop(pid)
        MACHINE.run(f"kill {pad}; wait {pad}", succeeds=False)

    def fingers(self):
        """The positions of the fingers on the surface."""
        fields = json.loads(MACHINE.run("merlin shm dump --json"))["/merlin-devices"]
        if not fields["touch.fingers"].get("value"):  # also before the first sample
            return []
        places = fields["touch.position"]["value"]
        return [places[2 * i:2 * i + 2] for i in range(fields["touch.fingers"]["value"])]

    def values(self):
        fields = json.loads(MACHINE.run("merlin shm dump --json"))["/merlin-devices"]
        return fields["ball.rotation"]["value"][1], fields["ball.buttons"]["value"]


if __name__ == "__main__":
    OPTIONS, argv = vm.arguments()
    unittest.main(argv=argv, failfast=True)
