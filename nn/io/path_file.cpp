#include "nn/io/path_file.h"

#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/base/printable_text.h"

namespace merlin::nn {
namespace {

constexpr std::string_view kPathHeader = "gesture,time_s,x_m,y_m,z_m,qw,qx,qy,qz";
constexpr std::string_view kSyntheticPaths = "# synthetic: nobody was measured";
constexpr std::size_t kLargestPathFile = std::size_t{1} << 28;  // bytes: about 4 million poses
constexpr std::size_t kPathNumbers = 8;
constexpr double kMostTime_s = 1e9, kMostPlace_m = 100, kMostTurn = 1.001, kLeastNorm = 0.9;

std::optional<double> numberOf(std::string_view text, double most) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return std::abs(value) <= most ? std::optional(value) : std::nullopt;
}

class PathParser {
 public:
  PathParser(std::string_view text, const std::string& file) : rest_(text), file_(file) {}

  Result<PathRecording> run() {
    std::string_view header = line();
    for (; header.starts_with('#'); header = line())
      recording_.synthetic = recording_.synthetic || header.starts_with("# synthetic");
    if (header != kPathHeader)
      return fault(fmt::format("the header \"{}\"", excerpt(header)),
                   fmt::format("\"{}\"", kPathHeader));
    while (!rest_.empty()) {
      const std::string_view row = line();
      if (row.empty()) continue;
      if (auto error = readRow(row)) return *std::move(error);
    }
    if (recording_.poses.empty()) return fault("no poses", "at least one line after the header");
    return std::move(recording_);
  }

 private:
  Error fault(std::string_view found, std::string_view allowed) const {
    return {Errc::kMalformed,
            fmt::format("{}:{}: found {}; allowed: {}", file_, number_, found, allowed)};
  }

  std::string_view line() {
    ++number_;
    const std::size_t end = rest_.find('\n');
    std::string_view row = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (row.ends_with('\r')) row.remove_suffix(1);
    return row;
  }

  std::optional<Error> readRow(std::string_view row) {
    const std::size_t comma = row.find(',');
    const std::string_view label = row.substr(0, comma);
    if (label != kNoGesture && !isGestureName(label))
      return fault(fmt::format("gesture \"{}\"", excerpt(label)),
                   fmt::format("1 to {} letters, digits, - or _; \"{}\" for ordinary motion",
                               kLongestGestureName, kNoGesture));
    row = comma == std::string_view::npos ? std::string_view() : row.substr(comma + 1);
    std::array<double, kPathNumbers> numbers{};
    for (std::size_t i = 0; i < kPathNumbers; ++i) {
      const std::size_t end = i + 1 < kPathNumbers ? row.find(',') : row.size();
      const double most = i == 0 ? kMostTime_s : i < 4 ? kMostPlace_m : kMostTurn;
      const auto value =
          end == std::string_view::npos ? std::nullopt : numberOf(row.substr(0, end), most);
      if (!value)
        return fault(fmt::format("\"{}\" where number {} of the line begins", excerpt(row), i + 1),
                     fmt::format("{} numbers after the gesture, this one from {} to {}",
                                 kPathNumbers, -most, most));
      numbers[i] = *value;
      row.remove_prefix(std::min(end + 1, row.size()));
    }
    return add(label, numbers);
  }

  std::optional<Error> add(std::string_view label,
                           const std::array<double, kPathNumbers>& numbers) {
    LabelledPose p;
    p.label = recording_.labelled(label);
    if (recording_.labels.size() > kMostGestures + 1)
      return fault(fmt::format("{} gestures", recording_.labels.size()),
                   fmt::format("{}", kMostGestures));
    p.pose.at_ns = static_cast<std::int64_t>(std::llround(numbers[0] * 1e6)) * 1000;
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) p.pose.position_m[i] = static_cast<float>(numbers[1 + i]);
    for (std::size_t i = 0; i < 4; ++i) {
      p.pose.orientation_wxyz[i] = static_cast<float>(numbers[4 + i]);
      square += numbers[4 + i] * numbers[4 + i];
    }
    if (std::sqrt(square) < kLeastNorm)
      return fault(fmt::format("a quaternion of length {:.3f}", std::sqrt(square)), "length 1");
    recording_.poses.push_back(p);
    return std::nullopt;
  }

  std::string_view rest_;
  const std::string& file_;
  std::size_t number_ = 0;
  PathRecording recording_;
};

}  // namespace

Result<PathRecording> parsePaths(std::string_view text, const std::string& file) {
  if (text.size() > kLargestPathFile)
    return Error{Errc::kMalformed, fmt::format("{}: found {} bytes; allowed: {}", file, text.size(),
                                               kLargestPathFile)};
  return PathParser(text, file).run();
}

Result<PathRecording> loadPaths(const std::string& path) {
  const auto file = FileCopy::read(path, kLargestPathFile + 1);
  if (!file) return file.error();
  return parsePaths(file->text(), path);
}

std::string formatPaths(const PathRecording& recording) {
  std::string out = recording.synthetic ? std::string(kSyntheticPaths) + "\n" : "";
  out += fmt::format("{}\n", kPathHeader);
  for (const LabelledPose& p : recording.poses) {
    const auto& [x, y, z] = p.pose.position_m;
    const auto& [qw, qx, qy, qz] = p.pose.orientation_wxyz;
    fmt::format_to(std::back_inserter(out), "{},{:.6f},{},{},{},{},{},{},{}\n",
                   recording.labels[p.label], static_cast<double>(p.pose.at_ns) * 1e-9, x, y, z, qw,
                   qx, qy, qz);
  }
  return out;
}

Result<Ok> savePaths(const std::string& path, const PathRecording& recording) {
  const std::string text = formatPaths(recording);
  if (const auto read = parsePaths(text, path); !read)
    return Error{Errc::kInvalidArgument, "not written: " + read.error().what};
  return writeFile(path, text);
}

}  // namespace merlin::nn
