#include "daemon/wall/content_requests.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "daemon/base/printable_text.h"
#include "daemon/wall/shown_models.h"

namespace merlin::wall {
namespace {

std::vector<std::string> pathsOf(const std::vector<ContentEntry>& entries) {
  std::vector<std::string> paths;
  for (const ContentEntry& entry : entries) paths.push_back(entry.path);
  return paths;
}

Error notShownYet() { return {Errc::kBusy, "the wall has not shown its first frame yet"}; }

}  // namespace

ContentRequests::ContentRequests(const ContentRequestParts& parts)
    : parts_(parts), folder_(parts.wall.shown, pathsOf(parts.entries)) {}

void ContentRequests::makeFolder() {
  if (const auto made = folder_.make(); !made) parts_.watch.report(faultEvent(made.error().what));
}

Result<std::uint32_t> ContentRequests::show(const std::string& name) {
  WallLoop* const loop = parts_.loop.load();
  if (!loop) return notShownYet();
  const auto named = std::ranges::find(parts_.entries, name, &ContentEntry::name);
  if (named == parts_.entries.end()) {
    for (const NamedFile& shown : folder_.namedFiles()) {
      if (shown.name == name) return showFile(shown.file);
    }
    return noSuchName(name);
  }
  const auto place = static_cast<std::size_t>(named - parts_.entries.begin());
  if (const std::string fault = parts_.missing.faultOf(place); !fault.empty()) {
    return Error{Errc::kInvalidArgument,
                 fmt::format("{} cannot be shown until its file can be read: {}", name, fault)};
  }
  const std::uint32_t number = ++count_;
  loop->show(place);
  loop->finishRequest(number, {});
  return number;
}

Error ContentRequests::noSuchName(const std::string& name) const {
  const std::vector<std::string> files = namesInFolder();
  return {Errc::kInvalidArgument,
          fmt::format("\"{}\" is not the name of a content; contents are {}{}{}", excerpt(name),
                      namesOf(parts_.entries),
                      files.empty() ? ""
                                    : fmt::format(", and of files that were shown {}",
                                                  fmt::join(files, ", ")),
                      name.find('/') == std::string::npos
                          ? ""
                          : "; merlind opens no path that a client names: `merlin show FILE` puts "
                            "the file into its content folder")};
}

std::vector<std::string> ContentRequests::namesInFolder() const {
  constexpr std::size_t kMost = 50;  // keeps status and error messages short
  std::vector<std::string> names;
  for (NamedFile& file : folder_.namedFiles()) {
    if (names.size() == kMost) break;
    if (std::ranges::find(parts_.entries, file.name, &ContentEntry::name) == parts_.entries.end())
      names.push_back(std::move(file.name));
  }
  return names;
}

std::vector<std::pair<std::string, std::string>> ContentRequests::missing() const {
  std::vector<std::pair<std::string, std::string>> missing;
  const std::vector<std::string> faults = parts_.missing.faults();
  for (std::size_t i = 0; i < faults.size(); ++i) {
    if (!faults[i].empty()) missing.emplace_back(parts_.entries[i].name, faults[i]);
  }
  return missing;
}

Result<std::uint32_t> ContentRequests::showFile(const std::string& name) {
  if (!parts_.loop.load()) return notShownYet();
  const auto entry = folder_.entryOf(name);
  if (!entry) return entry.error();
  const std::uint32_t number = ++count_;
  if (const auto shown = showEntry(*entry, number); !shown) return shown.error();
  for (std::string& fault : folder_.tidy(name)) parts_.watch.report(faultEvent(std::move(fault)));
  return number;
}

// Shows a content of the content folder. A model is read by the thread of ModelWatch, since that
// may take long; a picture is read here.
Result<Ok> ContentRequests::showEntry(const ContentEntry& entry, std::uint32_t request) {
  const auto read = [this, entry, request]() -> Result<ReadyModel> {
    std::vector<std::string> skipped;
    auto content = readContent(entry, parts_.wall.render.model.show, {}, skipped);
    for (const std::string& why : skipped) parts_.watch.report(faultEvent(why));
    if (!content) return content.error();
    auto ready = prepareContent(parts_.entries.size(), *std::move(content), parts_.wall);
    if (!ready) return ready.error();
    ready->asked_for = true;
    ready->request = request;
    return ready;
  };
  if (entry.kind == ContentKind::kModel) {
    parts_.watch.ask(read, request);
    parts_.attendance.touch();
    return Ok{};
  }
  auto ready = read();
  if (!ready) return ready.error();
  parts_.attendance.touch();
  parts_.watch.offer(*std::move(ready));
  return Ok{};
}

}  // namespace merlin::wall
