#include "render/import/model_unit.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include <zip.h>

#include "daemon/base/printable_text.h"

namespace merlin::render::import {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

// Returns the text after `begin`, up to the first character that is in `end`; empty if `begin` or
// such a character is missing.
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

std::string beginningOf3mf(const std::string& path, std::size_t most) {
  const std::unique_ptr<zip_t, void (*)(zip_t*)> archive(
      zip_open(path.c_str(), ZIP_RDONLY, nullptr), [](zip_t* open) { zip_discard(open); });
  if (!archive) return {};
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> model(
      zip_fopen(archive.get(), "3D/3dmodel.model", ZIP_FL_NOCASE), zip_fclose);
  if (!model) return {};
  std::string text(most, '\0');
  const zip_int64_t got = zip_fread(model.get(), text.data(), text.size());
  text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return text;
}

double metresPer(std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, double>, 8> kUnits = {{{"micron", 1e-6},
                                                                          {"millimeter", 1e-3},
                                                                          {"centimeter", 1e-2},
                                                                          {"meter", 1},
                                                                          {"inch", 0.0254},
                                                                          {"foot", 0.3048},
                                                                          {"feet", 0.3048},
                                                                          {"mm", 1e-3}}};
  const auto found =
      std::find_if(kUnits.begin(), kUnits.end(), [&](const auto& u) { return u.first == unit; });
  return found == kUnits.end() ? 0 : found->second;
}

}  // namespace merlin::render::import
