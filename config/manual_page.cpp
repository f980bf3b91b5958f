#include "config/manual_page.h"

#include <deque>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/settings.h"
#include "config/visitor.h"
#include "daemon/manual/roff.h"

namespace merlin {
namespace {

using manual::roffBold;
using manual::roffText;

// Writes a section for each object of the configuration. The section of an object precedes those of
// the objects in it.
class ManualWriter final : public SettingsVisitor {
 public:
  void number(const char* key, double& value, Range range, const char* help) override {
    add(key, fmt::format("number, {} to {}; default {}", range.low, range.high, shortest(value)),
        help);
  }
  void integer(const char* key, int& value, Range range, const char* help) override {
    add(key,
        fmt::format("whole number, {:.0f} to {:.0f}; default {}", range.low, range.high, value),
        help);
  }
  void flag(const char* key, bool& value, const char* help) override {
    add(key, fmt::format("true or false; default {}", value), help);
  }
  void text(const char* key, std::string& value, const char* help) override {
    add(key, "text" + (value.empty() ? std::string() : fmt::format("; default \"{}\"", value)),
        help);
  }
  void texts(const char* key, std::vector<std::string>&, const char* help) override {
    add(key, "list of texts", help);
  }
  void path(const char* key, std::string& value, const char* help) override {
    add(key, "file name" + (value.empty() ? std::string() : fmt::format("; default {}", value)),
        help);
  }
  void choice(const char* key, int& value, std::span<const char* const> names,
              const char* help) override {
    add(key,
        fmt::format("one of {}{}", fmt::join(names, ", "),
                    value < 0
                        ? std::string()
                        : fmt::format("; default {}", names[static_cast<std::size_t>(value)])),
        help);
  }
  void numbers(const char* key, std::span<double> values, Range range, const char* help) override {
    add(key, fmt::format("list of {} numbers, {} to {}", values.size(), range.low, range.high),
        help);
  }
  void group(const char* key, const char* help, const std::function<void()>& members) override {
    within(key, help, members);
  }
  void groupIf(bool, const char* key, const char* help, const std::function<void()>& members,
               const char*) override {
    group(key, help, members);
  }
  void list(const char* key, std::size_t count, const char* help,
            const std::function<void(std::size_t)>& resize,
            const std::function<void(std::size_t)>& member) override {
    resize(1);  // describes an entry with default values
    within(std::string(key) + "/0", std::string("List of objects. ") + help, [&] { member(0); });
    resize(count);
  }
  void excluded(const char*, const char*) override {}

  std::string page() const {
    std::string text;
    for (const std::string& section : sections_) text += section;
    return text;
  }

 private:
  // Formats a number as in the schema: a value that was stored in a float gets only the digits that
  // a float needs, 0.1 instead of 0.10000000149.
  static std::string shortest(double value) {
    const auto narrow = static_cast<float>(value);
    return static_cast<double>(narrow) == value ? fmt::format("{}", narrow)
                                                : fmt::format("{}", value);
  }
  void add(const char* key, const std::string& type, const std::string& help) {
    sections_[at_] +=
        fmt::format(".TP\n{} ({})\n{}\n", roffBold(key), roffText(type), roffText(help));
  }
  void within(const std::string& key, const std::string& help,
              const std::function<void()>& members) {
    const std::size_t outer_at = at_;
    const std::string outer_pointer = pointer_;
    pointer_ += "/" + key;
    at_ = sections_.size();
    sections_.push_back(fmt::format(".SS {}\n{}\n", roffText(pointer_), roffText(help)));
    members();
    at_ = outer_at;
    pointer_ = outer_pointer;
  }

  std::deque<std::string> sections_{""};
  std::size_t at_ = 0;
  std::string pointer_;
};

}  // namespace

std::string settingsManual(const std::string& version) {
  Settings settings;
  ManualWriter writer;
  describe(settings, writer);
  return manual::roffTitle("merlin.json", 5, version) +
         ".SH NAME\nmerlin.json \\- configuration of the display wall MERLIN\n"
         ".SH DESCRIPTION\n" +
         roffText(
             "merlind reads /etc/merlin/merlin.json, or the file that its option --config names. "
             "It is JSON; every setting may be left out, and an unknown one is an error. Files "
             "conf.d/*.json in the same folder are merged over it in the order of their names: "
             "objects by key; everything else, lists too, replaces what was there. `merlin config "
             "show` says which file each value comes from. File names are relative to the folder "
             "of the configuration. `merlind --check-config FILE` says "
             "what is wrong with a file, with the line and the JSON pointer of each finding, and "
             "`merlind --print-config` prints a configuration with every setting.") +
         "\n.SH SETTINGS\nEach heading is the JSON pointer of an object; 0 stands for any item of "
         "a list.\n" +
         writer.page() + ".SH FILES\n.TP\n\\fI/etc/merlin/merlin.schema.json\\fR\n" +
         roffText("JSON Schema of this file, by which editors complete and check it") +
         "\n.SH SEE ALSO\n" + roffBold("merlind") + "(8),\n" + roffBold("merlin") + "(1)\n";
}

}  // namespace merlin
