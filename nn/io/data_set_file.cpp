#include "nn/io/data_set_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "nn/io/csv_header.h"

namespace merlin::nn {
namespace {

constexpr std::size_t kLargestFile = std::size_t{1} << 26;  // bytes: about 300,000 hands
constexpr std::size_t kMostQuoted = 40;                     // characters of a field in an error
// The slot before a DIP is the same finger's PIP.
constexpr std::size_t kDip[] = {6, 10, 14, 18};
constexpr std::string_view kSyntheticLine = "# synthetic hands: nobody was measured";

std::string quote(std::string_view text) {
  std::string out = "\"";
  for (const char c : text.substr(0, kMostQuoted)) {
    const auto u = static_cast<unsigned char>(c);
    out += u >= 0x20 && u < 0x7F ? std::string(1, c) : fmt::format("\\x{:02X}", u);
  }
  return out + (text.size() > kMostQuoted ? "...\"" : "\"");
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> fields;
  for (;;) {
    const auto at = text.find(separator);
    fields.emplace_back(text.substr(0, at));
    if (at == std::string_view::npos) return fields;
    text.remove_prefix(at + 1);
  }
}

// Splits a text into lines that end with LF, CR LF or CR; the last may lack its end.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  std::optional<std::string_view> next() {
    if (rest_.empty()) return std::nullopt;
    ++number_;
    const auto at = rest_.find_first_of("\r\n");
    ended_ = at != std::string_view::npos;
    const auto line = rest_.substr(0, at);
    const bool two = ended_ && rest_[at] == '\r' && rest_.substr(at + 1).starts_with('\n');
    rest_.remove_prefix(ended_ ? at + (two ? 2 : 1) : rest_.size());
    return line;
  }
  std::size_t number() const { return number_; }
  bool ended() const { return ended_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
  bool ended_ = true;
};

// Converts a label as people write it into a posture's name; empty if that is impossible.
std::string postureName(std::string_view text) {
  std::string name(text);
  const auto outer = [](char c) { return c == '"' || c == '\'' || c == ' ' || c == '\t'; };
  while (!name.empty() && outer(name.front())) name.erase(0, 1);
  while (!name.empty() && outer(name.back())) name.pop_back();
  std::replace(name.begin(), name.end(), ' ', '-');
  if (name.ends_with(".0"))
    name.resize(name.size() - 2);  // "3.0": a class number that was saved as a float
  return isPostureName(name) ? name : std::string();
}

std::optional<float> parseValue(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  if (text.starts_with('+')) text.remove_prefix(1);
  float value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return std::abs(value) <= static_cast<float>(kMostRaw) ? std::optional(value) : std::nullopt;
}

class Parser {
 public:
  Parser(std::string_view text, const std::string& file, std::optional<InputUnit> unit,
         std::span<const ChosenColumn> columns)
      : lines_(text), file_(file), unit_(unit), columns_(columns) {}

  Result<Recording> run() {
    if (auto error = readColumns()) return *std::move(error);
    while (const auto line = lines_.next()) {
      if (line->empty()) continue;
      if (auto error = readHand(*line)) return *std::move(error);
    }
    if (recording_.hands.empty())
      return errorInLine("no hands", "at least one line after the header");
    if (!lines_.ended())
      recording_.notes.push_back(
          "the last line has no line end: if the file was truncated, its last number may be wrong");
    return finish();
  }

 private:
  Error errorInLine(std::string_view found, std::string_view allowed) const {
    return {Errc::kMalformed,
            fmt::format("{}:{}: found {}; allowed: {}", file_, lines_.number(), found, allowed)};
  }

  std::optional<Error> readColumns() {
    auto line = lines_.next();
    while (line && (line->starts_with('#') || line->empty())) {
      recording_.synthetic |= line->starts_with("# synthetic");
      line = lines_.next();
    }
    if (!line)
      return Error{Errc::kMalformed,
                   fmt::format("{}: found no header{}; needed are a header and at least one line "
                               "after it",
                               file_, lines_.number() == 0 ? ", the file is empty" : "")};
    std::string_view text = *line;
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    for (const char c : {',', ';', '\t'}) {
      if (text.find(c) == std::string_view::npos) continue;
      separator_ = c;
      break;
    }
    names_ = split(text, separator_);
    if (const auto fault = readHeader(names_, header_, columns_))
      return errorInLine(fault->substr(0, fault->find("; allowed: ")),
                         fault->substr(fault->find("; allowed: ") + 11));
    recording_.notes = header_.notes;
    for (std::size_t c = 0; c < names_.size(); ++c) {
      if (header_.slot[c] < 0) continue;
      bool& taken = recording_.measured[static_cast<std::size_t>(header_.slot[c])];
      if (taken) return errorInLine("two columns " + quote(names_[c]), "one a sensor");
      taken = true;
    }
    return std::nullopt;
  }

  std::optional<Error> readHand(std::string_view line) {
    const auto fields = split(line, separator_);
    if (fields.size() != names_.size())
      return errorInLine(fmt::format("{} fields", fields.size()),
                         fmt::format("{}, as many as the header has", names_.size()));
    LabelledHand hand;
    const std::string& label = fields[header_.label];
    hand.posture = postureName(label);
    if (hand.posture.empty())
      return errorInLine("posture " + quote(label),
                         fmt::format("1 to {} letters, digits, - or _", kLongestName));
    const auto [known, fresh] = labels_.try_emplace(hand.posture, label);
    if (!fresh && known->second != label)
      return errorInLine(fmt::format("the labels {} and {}, which are both {}",
                                     quote(known->second), quote(label), hand.posture),
                         "one way to write a label");
    for (std::size_t c = 0; c < fields.size(); ++c) {
      if (header_.slot[c] < 0) continue;
      const auto value = parseValue(fields[c]);
      if (!value) {
        const double most = unit_ == InputUnit::kRadians ? kMostAngle_rad : kMostRaw;
        return errorInLine(fmt::format("{} {}", names_[c], quote(fields[c])),
                           fmt::format("a number from {} to {}", -most, most));
      }
      hand.value[static_cast<std::size_t>(header_.slot[c])] = *value;
      if (std::abs(*value) <= static_cast<float>(kMostAngle_rad)) continue;
      if (unit_ == InputUnit::kRadians)
        return errorInLine(
            fmt::format("{} {}", names_[c], quote(fields[c])),
            fmt::format("an angle in radians, {} to {}", -kMostAngle_rad, kMostAngle_rad));
      far_ = true;
    }
    recording_.hands.push_back(std::move(hand));
    return std::nullopt;
  }

  // Chooses the unit, and computes missing DIP angles from the PIP angles as the glove's driver
  // does.
  Recording finish() {
    recording_.unit = unit_.value_or(far_ ? InputUnit::kRaw : InputUnit::kRadians);
    if (!unit_ && far_)
      recording_.notes.push_back("numbers are beyond +-6.3 and are assumed to be raw counts");
    for (LabelledHand& hand : recording_.hands) {
      for (const std::size_t dip : kDip) {
        const float pip = hand.value[dip - 1];
        if (recording_.unit == InputUnit::kRadians && !recording_.measured[dip])
          hand.value[dip] = 0.32F * pip * pip + 0.17F * pip;
      }
    }
    return std::move(recording_);
  }

  Lines lines_;
  const std::string& file_;
  std::optional<InputUnit> unit_;
  std::span<const ChosenColumn> columns_;
  char separator_ = ',';
  std::vector<std::string> names_;
  CsvHeader header_;
  std::map<std::string, std::string> labels_;  // maps a posture to its spelling in the file
  bool far_ = false;
  Recording recording_;
};

}  // namespace

Result<Recording> parseRecording(std::string_view text, const std::string& file,
                                 std::optional<InputUnit> unit,
                                 std::span<const ChosenColumn> columns) {
  if (text.size() > kLargestFile)
    return Error{Errc::kMalformed,
                 fmt::format("{}: found {} bytes; allowed: {}", file, text.size(), kLargestFile)};
  return Parser(text, file, unit, columns).run();
}

Result<Recording> loadRecording(const std::string& path, std::optional<InputUnit> unit,
                                std::span<const ChosenColumn> columns) {
  const auto file = FileCopy::read(path);
  if (!file) return file.error();
  return parseRecording(file->text(), path, unit, columns);
}

std::string formatRecording(const Recording& recording) {
  std::string out = recording.synthetic ? std::string(kSyntheticLine) + "\n" : "";
  out += "posture";
  for (std::size_t i = 0; i < kInputs; ++i) {
    if (recording.measured[i]) out += fmt::format(",{}", kInputNames[i]);
  }
  out += '\n';
  for (const LabelledHand& hand : recording.hands) {
    out += hand.posture;
    for (std::size_t i = 0; i < kInputs; ++i) {
      if (recording.measured[i]) fmt::format_to(std::back_inserter(out), ",{}", hand.value[i]);
    }
    out += '\n';
  }
  return out;
}

Result<Ok> saveRecording(const std::string& path, const Recording& recording) {
  const std::string text = formatRecording(recording);
  if (const auto read = parseRecording(text, path, recording.unit); !read)
    return Error{Errc::kInvalidArgument, "not written: " + read.error().what};
  return writeFile(path, text);
}

}  // namespace merlin::nn
