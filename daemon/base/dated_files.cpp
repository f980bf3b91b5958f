#include "daemon/base/dated_files.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace merlin {
namespace {

namespace fs = std::filesystem;

// Sort key of a file: its time, then its number within the second.
using Order = std::pair<std::string, int>;

constexpr std::string_view kTimeForm = "ddddddddTddddddZ";  // 20261123T045500Z

std::string timeOf(std::time_t time) { return fmt::format("{:%Y%m%dT%H%M%SZ}", fmt::gmtime(time)); }

bool isTime(std::string_view text) {
  return std::equal(
      text.begin(), text.end(), kTimeForm.begin(), kTimeForm.end(),
      [](char c, char form) { return form == 'd' ? c >= '0' && c <= '9' : c == form; });
}

// Parses the middle of a file's name, "-20261123T045500Z" or "-20261123T045500Z-2".
std::optional<Order> orderOf(std::string_view middle) {
  constexpr std::size_t kTime = 1 + kTimeForm.size();
  if (middle.size() < kTime || middle[0] != '-' || !isTime(middle.substr(1, kTime - 1)))
    return std::nullopt;
  Order order{middle.substr(1, kTime - 1), 1};
  if (middle.size() == kTime) return order;
  if (middle[kTime] != '-') return std::nullopt;
  const char* const end = middle.data() + middle.size();
  const auto [rest, error] = std::from_chars(middle.data() + kTime + 1, end, order.second);
  return error == std::errc() && rest == end ? std::optional(order) : std::nullopt;
}

}  // namespace

Result<std::string> DatedFiles::next(std::time_t now) const {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) return Error{Errc::kIo, fmt::format("{}: {}", folder_, error.message())};
  const std::string start = fmt::format("{}/{}-{}", folder_, name_, timeOf(now));
  for (int number = 1; number < 100'000; ++number) {
    auto path = number == 1 ? start + ending_ : fmt::format("{}-{}{}", start, number, ending_);
    if (!fs::exists(fs::symlink_status(path, error))) return path;
  }
  return Error{Errc::kIo, start + ending_ + ": all file names of this second are taken; try again"};
}

void DatedFiles::removeOldest(std::time_t now) const {
  const std::string latest = timeOf(now);
  std::vector<std::pair<Order, fs::path>> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string file = entry->path().filename().string();
    std::error_code ignored;
    if (file.size() < name_.size() + ending_.size() || !file.starts_with(name_) ||
        !file.ends_with(ending_) || !fs::is_regular_file(entry->symlink_status(ignored)))
      continue;
    const std::string_view middle =
        std::string_view(file).substr(name_.size(), file.size() - name_.size() - ending_.size());
    auto order = orderOf(middle);
    if (order && order->first > latest) order->first.clear();
    if (order) files.emplace_back(*order, entry->path());
  }
  std::sort(files.begin(), files.end());
  for (std::size_t i = 0; i + most_ < files.size(); ++i) fs::remove(files[i].second, error);
}

}  // namespace merlin
