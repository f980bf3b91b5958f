#include "drivers/io/gpio_chip.h"

#include <cerrno>
#include <cstring>
#include <map>

#include <fmt/format.h>
#include <gpiod.h>

namespace merlin::io {
namespace {

constexpr const char* kConsumer = "merlin";

Error chipError(const std::string& chip, const std::string& what) {
  const int error = errno;
  const Errc code = error == ENOENT || error == ENODEV ? Errc::kNotFound
                    : error == EBUSY                   ? Errc::kBusy
                    : error == EINVAL                  ? Errc::kInvalidArgument
                                                       : Errc::kIo;
  const char* hint = error == EACCES ? " (its group is usually gpio: usermod -aG gpio USER)" : "";
  return {code, fmt::format("{}: {}: {}{}", chip, what, std::strerror(error), hint)};
}

class ChipLines final : public GpioLines {
 public:
  ChipLines(gpiod_chip* chip, std::string name) : chip_(chip), name_(std::move(name)) {}
  ~ChipLines() override { ::gpiod_chip_close(chip_); }  // releases its lines
  ChipLines(const ChipLines&) = delete;
  ChipLines& operator=(const ChipLines&) = delete;

  Result<Ok> add(int number, bool output) {
    if (number < 0) return Ok{};
    if (static_cast<unsigned>(number) >= ::gpiod_chip_num_lines(chip_))
      return Error{Errc::kInvalidArgument,
                   fmt::format("{} has no line {}; it has {} lines, from 0 on", name_, number,
                               ::gpiod_chip_num_lines(chip_))};
    gpiod_line* line = ::gpiod_chip_get_line(chip_, static_cast<unsigned>(number));
    const int done = !line    ? -1
                     : output ? ::gpiod_line_request_output(line, kConsumer, 0)
                              : ::gpiod_line_request_both_edges_events(line, kConsumer);
    if (done != 0 && line && errno == EBUSY) return held(line, number);
    if (done != 0) return chipError(name_, fmt::format("line {}", number));
    lines_[number] = line;
    if (!output) input_ = line;
    return Ok{};
  }

  Result<Ok> write(int line, bool high) override {
    if (line < 0) return Ok{};
    if (::gpiod_line_set_value(lines_.at(line), high ? 1 : 0) == 0) return Ok{};
    return chipError(name_, fmt::format("writing line {}", line));
  }

  Result<bool> read(int line) override {
    if (line < 0) return false;
    const int value = ::gpiod_line_get_value(lines_.at(line));
    if (value >= 0) return value == 1;
    return chipError(name_, fmt::format("reading line {}", line));
  }

  Result<Ok> wait(Duration timeout) override {
    timespec limit{timeout / std::chrono::seconds(1), (timeout % std::chrono::seconds(1)).count()};
    if (!input_) {
      ::nanosleep(&limit, nullptr);
      return answers();
    }
    const int ready = ::gpiod_line_event_wait(input_, &limit);
    gpiod_line_event event{};
    if (ready > 0 && ::gpiod_line_event_read(input_, &event) == 0) return Ok{};
    if (ready == 0 || (ready < 0 && errno == EINTR)) return Ok{};
    return chipError(name_, "waiting for the button");
  }

 private:
  Error held(gpiod_line* line, int number) const {
    const char* const by = ::gpiod_line_update(line) == 0 ? ::gpiod_line_consumer(line) : nullptr;
    return {Errc::kBusy, fmt::format("{}: another program or a driver holds line {}{}{}", name_,
                                     number, by ? ": " : "", by ? by : "")};
  }

  // Checks whether the chip is still there; an output alone would not show it before the next
  // write. Asks the kernel instead of reading the line, because some chips cannot read.
  Result<Ok> answers() const {
    if (lines_.empty() || ::gpiod_line_update(lines_.begin()->second) == 0) return Ok{};
    return chipError(name_, fmt::format("line {}", lines_.begin()->first));
  }

  gpiod_chip* chip_;
  std::string name_;
  std::map<int, gpiod_line*> lines_;
  gpiod_line* input_ = nullptr;
};

// Lists the existing chips, because a chip that was unplugged may have another number afterwards.
Error noChip(const std::string& chip) {
  std::string others;
  gpiod_chip_iter* const all = ::gpiod_chip_iter_new();
  while (gpiod_chip* other = all ? ::gpiod_chip_iter_next(all) : nullptr)
    others += fmt::format("{}{} ({})", others.empty() ? "" : ", ", ::gpiod_chip_name(other),
                          ::gpiod_chip_label(other));
  if (all) ::gpiod_chip_iter_free(all);
  return {Errc::kNotFound, fmt::format("there is no GPIO chip {}; this machine has {}", chip,
                                       others.empty() ? "none" : others)};
}

}  // namespace

Result<std::unique_ptr<GpioLines>> openGpioChip(const std::string& chip,
                                                const std::vector<int>& outputs, int input) {
  gpiod_chip* opened = ::gpiod_chip_open_lookup(chip.c_str());
  if (!opened) return errno == ENOENT ? noChip(chip) : chipError(chip, "open");
  auto lines = std::make_unique<ChipLines>(opened, chip);
  for (const int line : outputs) {
    if (const auto added = lines->add(line, true); !added) return added.error();
  }
  if (const auto added = lines->add(input, false); !added) return added.error();
  return std::unique_ptr<GpioLines>(std::move(lines));
}

}  // namespace merlin::io
