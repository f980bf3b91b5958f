#include "daemon/manual/roff.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace merlin::manual {
namespace {

bool isLetter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

std::string escaped(std::string_view text, bool joins) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool joined =
        joins && i > 0 && i + 1 < text.size() && isLetter(text[i - 1]) && isLetter(text[i + 1]);
    if (text[i] == '\\')
      out += "\\e";
    else if (text[i] == '-' && !joined)
      out += "\\-";
    else
      out += text[i];
  }
  return out;
}

}  // namespace

std::string roffText(std::string_view text) {
  const bool instruction = text.starts_with('.') || text.starts_with('\'');
  return (instruction ? "\\&" : "") + escaped(text, true);
}

std::string roffBold(std::string_view text) { return "\\fB" + escaped(text, false) + "\\fR"; }
std::string roffItalic(std::string_view text) { return "\\fI" + escaped(text, false) + "\\fR"; }

std::string roffLines(std::string_view lines) {
  std::string out;
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    const std::string_view line = lines.substr(0, end);
    lines.remove_prefix(std::min(end + 1, lines.size()));
    const std::size_t command = line.find(": ");
    if (line.empty()) continue;
    if (!out.empty()) out += ".br\n";
    if (line.starts_with("Example") && command != std::string_view::npos)
      out += roffText(line.substr(0, command + 2)) + roffBold(line.substr(command + 2)) + "\n";
    else
      out += roffText(line) + "\n";
  }
  return out;
}

std::string roffTitle(std::string_view name, int section, std::string_view version) {
  std::string upper(name);
  std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return std::toupper(c); });
  return fmt::format(".TH \"{}\" {} \"\" \"MERLIN {}\" \"MERLIN\"\n", escaped(upper, false),
                     section, version);
}

}  // namespace merlin::manual
