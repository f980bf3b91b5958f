// SettingsVisitor: an interface. A description of settings calls one of its functions for every
// setting. The classes that read a file, write the schema and the manual page, and print or compare
// the settings in effect are visitors of the same description, so that they always agree.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace merlin {

struct Range {
  double low, high;
  // For number() only. If set, a value outside the range is refused instead of being replaced by
  // the nearest allowed one, because that would have another meaning. The text ends the message; it
  // says what is usual.
  const char* refused = nullptr;
};

class SettingsVisitor {
 public:
  virtual ~SettingsVisitor() = default;

  // `help`: what the setting means, in full sentences, with the unit. `value`: the present value,
  // which the visitor may change.
  virtual void number(const char* key, double& value, Range range, const char* help) = 0;
  virtual void integer(const char* key, int& value, Range range, const char* help) = 0;
  virtual void flag(const char* key, bool& value, const char* help) = 0;
  virtual void text(const char* key, std::string& value, const char* help) = 0;
  // Describes a list of any number of texts.
  virtual void texts(const char* key, std::vector<std::string>& values, const char* help) = 0;
  // Describes a file name, relative to the folder of the configuration.
  virtual void path(const char* key, std::string& value, const char* help) = 0;
  // Describes the name of a file that holds a secret: a password, a secret key. Output that is
  // meant for strangers omits the name as well, since some people enter the secret itself there.
  virtual void secretFile(const char* key, std::string& value, const char* help) {
    path(key, value, help);
  }
  // Describes a choice: the setting is one of `names`; `value` is its index, or negative if there
  // is no default.
  virtual void choice(const char* key, int& value, std::span<const char* const> names,
                      const char* help) = 0;
  // Describes a list of exactly values.size() numbers.
  virtual void numbers(const char* key, std::span<double> values, Range range,
                       const char* help) = 0;
  // Describes a list of exactly values.size() whole numbers.
  virtual void wholeNumbers(const char* key, std::span<double> values, Range range,
                            const char* help) {
    numbers(key, values, range, help);
  }
  virtual void group(const char* key, const char* help, const std::function<void()>& members) = 0;
  // Describes a list of any number of objects: resize(n) sets their number, member(i) describes
  // object i. `count`: their present number.
  virtual void list(const char* key, std::size_t count, const char* help,
                    const std::function<void(std::size_t)>& resize,
                    const std::function<void(std::size_t)>& member) = 0;

  // Describes a key that a file must not have, since another setting determines its value. `what`:
  // the message about it, without the key, with which the sentence begins.
  virtual void excluded(const char* key, const char* what) = 0;

  // Describes a group that is valid only if `active`, which depends on another setting. `what`: why
  // a file must not have the group otherwise, as in excluded(). Visitors that describe all possible
  // files (schema, manual page) override this to describe the group in any case.
  virtual void groupIf(bool active, const char* key, const char* help,
                       const std::function<void()>& members, const char* what) {
    if (active)
      group(key, help, members);
    else
      excluded(key, what);
  }

  // Overloads for other number types and for enumerations.
  void number(const char* key, float& value, Range range, const char* help) {
    double wide = static_cast<double>(value);
    number(key, wide, range, help);
    value = static_cast<float>(wide);
  }
  void integer(const char* key, std::size_t& value, Range range, const char* help) {
    int narrow = static_cast<int>(value);
    integer(key, narrow, range, help);
    value = static_cast<std::size_t>(narrow);
  }
  template <typename T, std::size_t N>
  void numbers(const char* key, std::array<T, N>& values, Range range, const char* help) {
    std::array<double, N> wide{};
    for (std::size_t i = 0; i < N; ++i) wide[i] = static_cast<double>(values[i]);
    if constexpr (std::is_integral_v<T>)
      wholeNumbers(key, wide, range, help);
    else
      numbers(key, std::span<double>(wide), range, help);
    for (std::size_t i = 0; i < N; ++i) values[i] = static_cast<T>(wide[i]);
  }
  template <typename Enum>
  void oneOf(const char* key, Enum& value, std::span<const char* const> names, const char* help) {
    int index = static_cast<int>(value);
    choice(key, index, names, help);
    value = static_cast<Enum>(index);
  }
  // Describes a choice whose value is a text: one of `names`, or empty if there is no default.
  void choiceOf(const char* key, std::string& value, std::span<const char* const> names,
                const char* help) {
    int index = -1;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (value == names[i]) index = static_cast<int>(i);
    }
    choice(key, index, names, help);
    value = index < 0 ? "" : names[static_cast<std::size_t>(index)];
  }
  template <typename T>
  void listOf(const char* key, std::vector<T>& values, const char* help,
              const std::function<void(T&)>& member) {
    list(
        key, values.size(), help, [&](std::size_t n) { values.assign(n, T{}); },
        [&](std::size_t i) { member(values[i]); });
  }
};

}  // namespace merlin
