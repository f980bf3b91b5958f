// make_gamepad: an input device of the kernel, made by uinput, for the tests in the virtual
// machine: a gamepad with two sticks and two buttons. Prints the path of its file, then takes one
// report per line of its input, "TYPE CODE VALUE" in numbers of linux/input-event-codes.h; is
// unplugged when its input ends, or by a signal.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>

#include <libevdev/libevdev-uinput.h>
#include <libevdev/libevdev.h>

namespace {

[[noreturn]] void fail(const char* step, int error) {
  std::fprintf(stderr, "make_gamepad: %s: %s\n", step, std::strerror(error));
  std::exit(1);
}

}  // namespace

int main() {
  libevdev* const device = libevdev_new();
  libevdev_set_name(device, "made-up gamepad of a test");
  input_absinfo stick{};
  stick.minimum = -32768;
  stick.maximum = 32767;
  for (const int code : {ABS_X, ABS_Y, ABS_RX, ABS_RY})
    libevdev_enable_event_code(device, EV_ABS, static_cast<unsigned>(code), &stick);
  for (const int code : {BTN_SOUTH, BTN_EAST})
    libevdev_enable_event_code(device, EV_KEY, static_cast<unsigned>(code), nullptr);
  libevdev_uinput* made = nullptr;
  if (const int status =
          libevdev_uinput_create_from_device(device, LIBEVDEV_UINPUT_OPEN_MANAGED, &made))
    fail("uinput", -status);
  std::printf("%s\n", libevdev_uinput_get_devnode(made));
  std::fflush(stdout);
  unsigned type = 0, code = 0;
  int value = 0;
  while (std::scanf("%u %u %d", &type, &code, &value) == 3) {
    int status = libevdev_uinput_write_event(made, type, code, value);
    if (status == 0) status = libevdev_uinput_write_event(made, EV_SYN, SYN_REPORT, 0);
    if (status != 0) fail("event", -status);
  }
  libevdev_uinput_destroy(made);
  libevdev_free(device);
  return 0;
}
