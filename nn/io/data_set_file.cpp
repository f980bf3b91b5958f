#include "nn/io/data_set_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "daemon/base/files.h"

namespace merlin::nn {
namespace {

constexpr std::size_t kLargestFile = std::size_t{1} << 26;  // bytes: about 300,000 hands
constexpr std::size_t kMostQuoted = 40;                     // characters of a field in an error

std::string headerLine() {
  std::string header = "posture";
  for (std::size_t i = 0; i < kInputs; ++i) header += fmt::format(",s{}", i);
  return header;
}

// Takes what stands before the next `separator` off `rest`, the separator too; all of it, if there
// is none.
std::string_view take(std::string_view& rest, char separator) {
  const auto at = rest.find(separator);
  const auto taken = rest.substr(0, at);
  rest.remove_prefix(at == std::string_view::npos ? rest.size() : at + 1);
  return taken;
}

std::string quote(std::string_view text) {
  std::string out = "\"";
  for (const char c : text.substr(0, kMostQuoted)) {
    const auto u = static_cast<unsigned char>(c);
    out += u >= 0x20 && u < 0x7F ? std::string(1, c) : fmt::format("\\x{:02X}", u);
  }
  return out + (text.size() > kMostQuoted ? "...\"" : "\"");
}

Error errorAt(const std::string& file, std::size_t line, std::string_view found,
              std::string_view allowed) {
  return {Errc::kMalformed,
          fmt::format("{}:{}: found {}; allowed: {}", file, line, found, allowed)};
}

std::optional<float> parseAngle(std::string_view text) {
  float angle = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), angle);
  if (code != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (!(std::abs(double{angle}) <= kMostAngle_rad)) return std::nullopt;
  return angle;
}

Result<LabelledHand> parseHand(std::string_view text, const std::string& file, std::size_t line) {
  LabelledHand hand;
  std::string_view rest = text;
  hand.posture = take(rest, ',');
  if (!isPostureName(hand.posture)) {
    return errorAt(file, line, "posture " + quote(hand.posture),
                   fmt::format("1 to {} letters, digits, - or _", kLongestName));
  }
  const auto fields = static_cast<std::size_t>(std::count(text.begin(), text.end(), ',')) + 1;
  if (fields != kInputs + 1) {
    return errorAt(file, line, fmt::format("{} fields", fields),
                   fmt::format("{}: the posture and {} angles", kInputs + 1, kInputs));
  }
  for (std::size_t i = 0; i < kInputs; ++i) {
    const std::string_view field = take(rest, ',');
    const auto angle = parseAngle(field);
    if (!angle) {
      return errorAt(file, line, fmt::format("s{} {}", i, quote(field)),
                     fmt::format("an angle in radians, {} to {}", -kMostAngle_rad, kMostAngle_rad));
    }
    hand.angle_rad[i] = *angle;
  }
  return hand;
}

}  // namespace

Result<DataSet> parseDataSet(std::string_view text, const std::string& file) {
  if (text.size() > kLargestFile) {
    return errorAt(file, 1, fmt::format("{} bytes", text.size()), fmt::format("{}", kLargestFile));
  }
  // A file that was cut in its last number would read well, and wrong.
  const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  if (!text.ends_with('\n')) {
    return errorAt(file, lines + 1, "no end of the line", "lines that end with a line feed");
  }
  if (const auto header = take(text, '\n'); header != headerLine()) {
    return errorAt(file, 1, quote(header), headerLine());
  }
  DataSet hands;
  hands.reserve(lines);
  for (std::size_t line = 2; !text.empty(); ++line) {
    auto hand = parseHand(take(text, '\n'), file, line);
    if (!hand) return hand.error();
    hands.push_back(*std::move(hand));
  }
  return hands;
}

Result<DataSet> loadDataSet(const std::string& path) {
  const auto file = MappedFile::open(path);
  if (!file) return file.error();
  return parseDataSet(file->text(), path);
}

std::string formatDataSet(std::span<const LabelledHand> hands) {
  std::string out = headerLine() + "\n";
  for (const LabelledHand& hand : hands) {
    out += hand.posture;
    for (const float angle : hand.angle_rad) fmt::format_to(std::back_inserter(out), ",{}", angle);
    out += '\n';
  }
  return out;
}

Result<Ok> saveDataSet(const std::string& path, std::span<const LabelledHand> hands) {
  const std::string text = formatDataSet(hands);
  if (const auto read = parseDataSet(text, path); !read) {
    return Error{Errc::kInvalidArgument, "not written: " + read.error().what};
  }
  return writeFile(path, text);
}

}  // namespace merlin::nn
