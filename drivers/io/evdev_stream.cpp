#include "drivers/io/evdev_stream.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <libevdev/libevdev.h>

#include "daemon/base/unique_fd.h"
#include "drivers/io/fd_wait.h"
#include "drivers/io/open_error.h"
#include "drivers/io/read_ahead.h"

namespace merlin::io {
namespace {

using Handle = std::unique_ptr<libevdev, decltype(&libevdev_free)>;

// Returns whether the kernel's answer, a negative errno value, means that the device was unplugged
// but its file still exists. The file vanishes a moment after the device.
bool isUnplugged(int answer) noexcept { return answer == -ENODEV || answer == -ENXIO; }

Error unplugged(const std::string& path) {
  return {Errc::kNotFound, path + ": the input device was unplugged while it was being opened"};
}

EvdevRecord numbered(EvdevRecord::Kind kind, unsigned code, std::int32_t value = 0) {
  EvdevRecord record;
  record.kind = kind;
  record.code = static_cast<std::uint16_t>(code);
  record.value = value;
  return record;
}

EvdevRecord named(EvdevRecord::Kind kind, unsigned code, std::string_view text) {
  EvdevRecord record = numbered(kind, code);
  std::copy_n(text.begin(), std::min(text.size(), EvdevRecord::kText), record.text.begin());
  return record;
}

// Returns "SOUTH" for BTN_SOUTH; for a key without a name, its number.
std::string keyName(unsigned code) {
  const char* const name = libevdev_event_code_get_name(EV_KEY, code);
  if (!name) return fmt::format("{}", code);
  const std::string_view text(name);
  return std::string(text.substr(std::min(text.size(), text.find('_') + 1)));
}

static_assert(kKeyCodes == KEY_CNT);

std::string cased(std::string_view text, int (*change)(int)) {
  std::string changed(text);
  std::ranges::transform(changed, changed.begin(),
                         [&](unsigned char c) { return static_cast<char>(change(c)); });
  return changed;
}

// Appends the fingers that touch a multi-touch device now, and the slot to which the next event
// belongs.
void appendFingers(const libevdev* device, std::string& out) {
  const int slots = libevdev_get_num_slots(device);  // -1: it has none
  const auto add = [&](int code, int value) {
    append(numbered(EvdevRecord::kMoved, static_cast<unsigned>(code), value), out);
  };
  for (int slot = 0; slot < slots; ++slot) {
    const auto at = static_cast<unsigned>(slot);
    if (libevdev_get_slot_value(device, at, ABS_MT_TRACKING_ID) < 0) continue;
    add(ABS_MT_SLOT, slot);
    for (const int code :
         {ABS_MT_TRACKING_ID, ABS_MT_POSITION_X, ABS_MT_POSITION_Y, ABS_MT_TOOL_TYPE}) {
      if (libevdev_has_event_code(device, EV_ABS, static_cast<unsigned>(code)))
        add(code, libevdev_get_slot_value(device, at, static_cast<unsigned>(code)));
    }
  }
  if (slots > 0) add(ABS_MT_SLOT, libevdev_get_current_slot(device));
}

// Returns the records of the description, then those of the present state.
std::string describe(const libevdev* device) {
  std::string out;
  std::string_view name = libevdev_get_name(device);
  for (; !name.empty(); name.remove_prefix(std::min(name.size(), EvdevRecord::kText)))
    append(named(EvdevRecord::kName, 0, name), out);
  for (unsigned code = 0; code < ABS_CNT; ++code) {
    const input_absinfo* const axis = libevdev_get_abs_info(device, code);
    if (!axis || !libevdev_has_event_code(device, EV_ABS, code)) continue;
    EvdevRecord record = numbered(EvdevRecord::kAxis, code, axis->value);
    record.low = axis->minimum;
    record.high = axis->maximum;
    record.resolution = axis->resolution;
    append(record, out);
  }
  for (unsigned code = 0; code < REL_CNT; ++code) {
    if (libevdev_has_event_code(device, EV_REL, code))
      append(numbered(EvdevRecord::kRelative, code), out);
  }
  for (unsigned code = 0; code < KEY_CNT; ++code) {
    if (!libevdev_has_event_code(device, EV_KEY, code)) continue;
    append(keyRecord(static_cast<std::uint16_t>(code)), out);
    if (libevdev_get_event_value(device, EV_KEY, code) != 0)
      append(numbered(EvdevRecord::kPressed, code, 1), out);
  }
  appendFingers(device, out);
  append(numbered(EvdevRecord::kReady, 0), out);
  return out;
}

void append(const input_event& event, std::string& out) {
  const auto add = [&](EvdevRecord::Kind kind) {
    merlin::append(numbered(kind, event.code, event.value), out);
  };
  switch (event.type) {
    case EV_ABS: return add(EvdevRecord::kMoved);
    case EV_REL: return add(EvdevRecord::kShifted);
    case EV_KEY: return add(EvdevRecord::kPressed);
    case EV_SYN:
      if (event.code == SYN_REPORT) add(EvdevRecord::kReport);
      return;
    default: return;
  }
}

class EvdevStream final : public ByteStream {
 public:
  EvdevStream(UniqueFd fd, Handle device)
      : fd_(std::move(fd)), device_(std::move(device)), ahead_{describe(device_.get()), 0} {
    ahead_.bytes.reserve(std::max(ahead_.bytes.size(), kAhead));
  }

  Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) override {
    if (ahead_.empty()) {
      if (const auto filled = fill(timeout); !filled) return filled.error();
    }
    return ahead_.take(buffer);
  }

  Result<std::size_t> write(std::span<const std::byte>, Duration) override {
    return Error{Errc::kIo, "nothing is written to an input device"};
  }

  void interrupt() noexcept override { wait_.interrupt(); }

 private:
  static constexpr std::size_t kAhead = 4096;  // bytes; a read from the kernel gives fewer
  static constexpr std::size_t kRecord = 24;

  Result<Ok> fill(Duration timeout) {
    ahead_.clear();
    // libevdev may have read events that the descriptor no longer has.
    if (libevdev_has_event_pending(device_.get()) <= 0) {
      if (auto ready = wait_.await(fd_.get(), POLLIN, timeout); !ready) return ready;
    }
    while (ahead_.bytes.size() + kRecord <= kAhead) {
      input_event event{};
      const unsigned flag = dropped_ ? LIBEVDEV_READ_FLAG_SYNC : LIBEVDEV_READ_FLAG_NORMAL;
      const int status = libevdev_next_event(device_.get(), flag, &event);
      if (status == -EAGAIN && !dropped_) break;
      if (status == -EAGAIN) {
        dropped_ = false;  // the state is known again
        continue;
      }
      if (status == -ENODEV) return Error{Errc::kClosed, "the input device was unplugged"};
      if (status < 0)
        return Error{Errc::kIo, fmt::format("the input device: {}", std::strerror(-status))};
      if (status == LIBEVDEV_READ_STATUS_SYNC) dropped_ = true;
      append(event, ahead_.bytes);
    }
    if (ahead_.empty()) return Error{Errc::kTimeout, "time-out"};  // all events were irrelevant
    return Ok{};
  }

  UniqueFd fd_;
  Handle device_;
  FdWait wait_;
  ReadAhead ahead_;       // records that read() has not returned yet
  bool dropped_ = false;  // the kernel dropped events; libevdev reports the changes
};

}  // namespace

EvdevRecord keyRecord(std::uint16_t code) { return named(EvdevRecord::kKey, code, keyName(code)); }

Result<std::unique_ptr<ByteStream>> openEvdev(const std::string& path) {
  return openEvdev(path, {libevdev_new_from_fd,
                          [](libevdev* device) { return libevdev_grab(device, LIBEVDEV_GRAB); }});
}

Result<std::unique_ptr<ByteStream>> openEvdev(const std::string& path,
                                              const EvdevRequests& requests) {
  UniqueFd fd(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!fd.valid()) return isUnplugged(-errno) ? unplugged(path) : openError(path, errno);
  libevdev* made = nullptr;
  const int described = requests.describe(fd.get(), &made);
  if (isUnplugged(described)) return unplugged(path);
  if (described < 0) return Error{Errc::kIo, path + ": is not an input device of the kernel"};
  Handle device(made, libevdev_free);
  const int grabbed = requests.grab(device.get());
  if (isUnplugged(grabbed)) return unplugged(path);
  if (grabbed < 0)
    return Error{Errc::kBusy,
                 path +
                     ": another device of this configuration, or a program such as spacenavd, "
                     "has grabbed this input device; name it once, and read what spacenavd "
                     "holds with the driver spacenav"};
  return std::unique_ptr<ByteStream>(
      std::make_unique<EvdevStream>(std::move(fd), std::move(device)));
}

std::optional<std::uint16_t> keyCode(std::string_view name) {
  const int code = libevdev_event_code_from_name(EV_KEY, cased(name, &std::toupper).c_str());
  if (code < 0 || code >= kKeyCodes) return std::nullopt;
  return static_cast<std::uint16_t>(code);
}

std::string keyNameOf(std::uint16_t code) {
  const char* const name = libevdev_event_code_get_name(EV_KEY, code);
  return name ? cased(name, &std::tolower) : "";
}

}  // namespace merlin::io
