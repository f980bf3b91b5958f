#include "daemon/cli/report/contents.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/cli/print.h"

namespace merlin::cli {
namespace {

// Returns whether the file is a picture or an EDID, which are binary and so contain no secrets as
// text.
bool isPicture(const std::string& name) {
  return name.ends_with(".png") || name.ends_with(".edid");
}

constexpr const char* kLeftOut =
    "Left out on purpose\n"
    "  Passwords, secret keys and the token of the web page: the files that hold them are not "
    "read\n"
    "  into this report, and the settings that name these files (password_file, keys,\n"
    "  samples_keys, commands_keys) say \"(left out)\" if they are set. So do the arguments of "
    "the\n"
    "  programs of alarms, which may be tokens. The configuration is here as the settings\n"
    "  that merlind understands, not as the file itself; text of the file that merlind does not\n"
    "  understand is left out. Where a secret that the user of merlin report can read, or the "
    "name\n"
    "  of such a file, or such an argument, stands in another text, such as the journal, it is\n"
    "  replaced by \"(left out)\"; secrets of fewer than four characters and arguments of fewer\n"
    "  than twelve are not looked for there.\n"
    "Not left out\n"
    "  The picture that the wall shows, names of contents and files, names and serial numbers of\n"
    "  devices and displays, network addresses in the configuration, what users did in the "
    "journal.\n"
    "  Look through it before you send it.\n";

}  // namespace

void makeFit(std::vector<CollectedPart>& parts, const KnownSecrets& secrets,
             std::size_t most_bytes) {
  std::size_t left = most_bytes;
  for (CollectedPart& part : parts) {
    std::vector<PackedFile> files;
    for (PackedFile& file : part.result.files) {
      if (!isPicture(file.name)) file.content = secrets.without(file.content);
      file.name = secrets.without(file.name);
      if (file.content.size() > left) {
        part.result.missing.push_back(fmt::format("{}: does not fit: a report has at most {} MB",
                                                  file.name, most_bytes / 1'000'000));
        continue;
      }
      left -= file.content.size();
      files.push_back(std::move(file));
    }
    part.result.files = std::move(files);
    for (std::string& what : part.result.missing) what = secrets.without(what);
  }
}

std::string readmeText(std::span<const CollectedPart> parts, const std::string& made) {
  std::string text = fmt::format(
      "A report about a display wall of MERLIN, made by `merlin report` at {}.\n\nWhat is in it\n",
      made);
  std::string missing;
  for (const CollectedPart& part : parts) {
    if (!part.result.files.empty()) text += fmt::format("  {}: {}\n", part.name, part.about);
    for (const PackedFile& file : part.result.files)
      text += fmt::format("    {}, {} bytes\n", file.name, file.content.size());
    for (const std::string& what : part.result.missing) missing += fmt::format("  {}\n", what);
  }
  return fmt::format("{}\nWhat is missing, and why\n{}\n{}", text,
                     missing.empty() ? "  nothing\n" : missing, kLeftOut);
}

std::string partsJson(std::span<const CollectedPart> parts, const std::string& archive,
                      std::size_t bytes) {
  nlohmann::ordered_json json = {{"file", archive}, {"bytes", bytes}};
  auto& list = json["parts"] = nlohmann::ordered_json::array();
  for (const CollectedPart& part : parts) {
    auto files = nlohmann::ordered_json::array();
    for (const PackedFile& file : part.result.files)
      files.push_back({{"name", file.name}, {"bytes", file.content.size()}});
    list.push_back({{"name", part.name},
                    {"about", part.about},
                    {"files", std::move(files)},
                    {"missing", part.result.missing}});
  }
  return jsonText(json);
}

std::vector<PackedFile> packedFiles(const std::vector<CollectedPart>& parts,
                                    const std::string& folder, const std::string& readme) {
  std::vector<PackedFile> files = {{folder + "/README.txt", readme}};
  for (const CollectedPart& part : parts) {
    for (const PackedFile& file : part.result.files)
      files.push_back({folder + "/" + file.name, file.content});
  }
  return files;
}

}  // namespace merlin::cli
