#include "render/import/model_unit.h"

#include <algorithm>

#include "daemon/base/printable_text.h"

namespace merlin::render::import {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

// From behind `begin` to before `end`; empty if one of them is missing.
std::string_view between(std::string_view text, std::string_view begin, std::string_view end) {
  const std::size_t at = text.find(begin);
  if (at == std::string_view::npos) return {};
  text.remove_prefix(at + begin.size());
  const std::size_t size = text.find_first_of(end);
  return size == std::string_view::npos ? std::string_view() : text.substr(0, size);
}

}  // namespace

std::string unitOf(std::string_view xml, std::string_view element) {
  constexpr std::string_view kName = "unit";
  std::string_view tag = between(xml, "<" + std::string(element), ">");
  for (std::size_t at = 0; (at = tag.find(kName, at)) != std::string_view::npos;) {
    const bool whole = at > 0 && kBlanks.find(tag[at - 1]) != std::string_view::npos;
    at += kName.size();
    std::string_view value = tag.substr(at);
    value.remove_prefix(std::min(value.find_first_not_of(kBlanks), value.size()));
    if (!whole || !value.starts_with('=')) continue;
    value.remove_prefix(std::min(value.find_first_of("\"'"), value.size()));
    if (value.empty()) return {};
    return oneLine(excerpt(between(value, value.substr(0, 1), value.substr(0, 1))));
  }
  return {};
}

}  // namespace merlin::render::import
