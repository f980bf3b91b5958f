// make_input KIND: makes a kernel input device by uinput, for the tests in the virtual machine: a
// gamepad with two sticks and two buttons, a touch frame with ten slots, or a mouse. Prints the
// path of the device's file. Then each line of its input becomes a report: several "TYPE CODE
// VALUE", as numbers of linux/input-event-codes.h. The device is unplugged when the input ends, or
// by a signal.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>

#include <libevdev/libevdev-uinput.h>
#include <libevdev/libevdev.h>

namespace {

[[noreturn]] void fail(const char* step, int error) {
  std::fprintf(stderr, "make_input: %s: %s\n", step, std::strerror(error));
  std::exit(1);
}

void addKeys(libevdev* device, std::initializer_list<int> codes) {
  for (const int code : codes)
    libevdev_enable_event_code(device, EV_KEY, static_cast<unsigned>(code), nullptr);
}

void addAxis(libevdev* device, int code, int low, int high, int resolution = 0) {
  input_absinfo axis{};
  axis.minimum = low;
  axis.maximum = high;
  axis.resolution = resolution;
  libevdev_enable_event_code(device, EV_ABS, static_cast<unsigned>(code), &axis);
}

void addGamepad(libevdev* device) {
  libevdev_set_name(device, "made-up gamepad of a test");
  for (const int code : {ABS_X, ABS_Y, ABS_RX, ABS_RY}) addAxis(device, code, -32768, 32767);
  addKeys(device, {BTN_SOUTH, BTN_EAST});
}

// The surface is 800 mm by 400 mm.
void addFrame(libevdev* device) {
  libevdev_set_name(device, "made-up frame of a test");
  for (const auto& [code, high] : {std::pair{ABS_X, 8000},
                                   {ABS_Y, 4000},
                                   {ABS_MT_POSITION_X, 8000},
                                   {ABS_MT_POSITION_Y, 4000}})
    addAxis(device, code, 0, high, 10);
  addAxis(device, ABS_MT_SLOT, 0, 9);
  addAxis(device, ABS_MT_TRACKING_ID, 0, 65535);
  addKeys(device, {BTN_TOUCH});
  libevdev_enable_property(device, INPUT_PROP_DIRECT);
}

void addMouse(libevdev* device) {
  libevdev_set_name(device, "made-up mouse of a test");
  for (const int code : {REL_X, REL_Y, REL_WHEEL})
    libevdev_enable_event_code(device, EV_REL, static_cast<unsigned>(code), nullptr);
  addKeys(device, {BTN_LEFT, BTN_RIGHT});
}

void report(libevdev_uinput* made, const std::string& line) {
  std::istringstream words(line);
  unsigned type = 0, code = 0;
  int value = 0, status = 0;
  while (status == 0 && words >> type >> code >> value)
    status = libevdev_uinput_write_event(made, type, code, value);
  if (status == 0) status = libevdev_uinput_write_event(made, EV_SYN, SYN_REPORT, 0);
  if (status != 0) fail("event", -status);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string kind = argc == 2 ? argv[1] : "";
  libevdev* const device = libevdev_new();
  if (kind == "gamepad")
    addGamepad(device);
  else if (kind == "frame")
    addFrame(device);
  else if (kind == "mouse")
    addMouse(device);
  else
    fail("needs gamepad, frame or mouse", EINVAL);
  libevdev_uinput* made = nullptr;
  if (const int status =
          libevdev_uinput_create_from_device(device, LIBEVDEV_UINPUT_OPEN_MANAGED, &made))
    fail("uinput", -status);
  std::printf("%s\n", libevdev_uinput_get_devnode(made));
  std::fflush(stdout);
  for (std::string line; std::getline(std::cin, line);) report(made, line);
  libevdev_uinput_destroy(made);
  libevdev_free(device);
  return 0;
}
