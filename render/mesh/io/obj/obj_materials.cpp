#include "render/mesh/io/obj/obj_materials.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/base/printable_text.h"
#include "render/mesh/io/companion_files.h"
#include "render/mesh/io/text_lines.h"
#include "render/mesh/io/texture_pictures.h"

namespace merlin::render::mesh {
namespace {

// Returns the number of words that follow an option of map_Kd; -1 if `option` is unknown.
int wordsOf(std::string_view option) {
  constexpr std::pair<std::string_view, int> kOptions[] = {
      {"-clamp", 1}, {"-blendu", 1}, {"-blendv", 1}, {"-cc", 1}, {"-bm", 1},      {"-boost", 1},
      {"-mm", 2},    {"-s", 3},      {"-o", 3},      {"-t", 3},  {"-imfchan", 1}, {"-texres", 1}};
  for (const auto& [name, words] : kOptions) {
    if (name == option) return words;
  }
  return -1;
}

class Library {
 public:
  // `opens`: whether images are read; if false, only their paths are kept.
  Library(const std::vector<std::string>& names, std::string folder,
          std::vector<std::string>& notes, bool opens)
      : files_(std::move(folder)), notes_(notes), materials_(names.size()), opens_(opens) {
    for (std::size_t i = 0; i < names.size(); ++i) numbers_.emplace(names[i], i);
  }

  void read(const std::string& name) {
    const auto file = MappedFile::open(files_.find(name));
    if (!file) {
      note(file.error().what + "; its materials are left out");
      return;
    }
    ObjMaterial* material = nullptr;  // null while the current material is one that no face uses
    for (std::string_view text = file->text(); !text.empty();) {
      std::string_view line = takeUncommented(text);
      const std::string_view keyword = takeWord(line);
      if (keyword == "newmtl")
        material = find(trimmed(line));
      else if (material && keyword == "Kd")
        takeDiffuse(line, *material);
      else if (material && keyword == "map_Kd")
        takeMap(line, *material);
    }
  }

  std::vector<ObjMaterial> take() {
    if (std::string other = files_.note(); !other.empty()) notes_.push_back(std::move(other));
    if (noted_ > kMostNotes)
      notes_.push_back(
          fmt::format("{} more notes about its materials are left out", noted_ - kMostNotes));
    return std::move(materials_);
  }

  std::vector<std::string> paths() const {
    std::vector<std::string> paths;
    for (const auto& [path, picture] : pictures_) paths.push_back(path);
    return paths;
  }

 private:
  static constexpr std::size_t kMostNotes = 16;

  void note(std::string text) {
    if (++noted_ <= kMostNotes) notes_.push_back(std::move(text));
  }

  ObjMaterial* find(std::string_view name) {
    const auto at = numbers_.find(name);
    return at == numbers_.end() || name.empty() ? nullptr : &materials_[at->second];
  }

  static void takeDiffuse(std::string_view line, ObjMaterial& material) {
    std::array<float, 3> colour{};
    for (float& x : colour) {
      if (!readNumber(takeWord(line), x) || !(x >= 0 && x <= 1)) return;
    }
    material.diffuse = colour;
  }

  void takeMap(std::string_view line, ObjMaterial& material) {
    std::string_view rest = trimmed(line);
    while (rest.starts_with('-')) {
      std::string_view after = rest;
      const std::string_view option = takeWord(after);
      int words = wordsOf(option);
      if (words < 0) break;  // `rest` is a file name that begins with '-'
      if (option == "-s" || option == "-o")
        note(fmt::format("map_Kd {}: the option {} is ignored", excerpt(line), option));
      float number = 0;
      for (bool first = true; words > 0; --words, first = false) {
        std::string_view next = after;
        const std::string_view word = takeWord(next);
        // The last two of three numbers may be missing.
        if (!first && wordsOf(option) == 3 && !readNumber(word, number)) break;
        if (option == "-clamp") material.clamped = word == "on";
        after = next;
      }
      rest = trimmed(after);
    }
    material.picture = pictureOf(files_.find(rest));
  }

  std::shared_ptr<const image::ImageFile> pictureOf(const std::string& path) {
    const auto known = pictures_.find(path);
    if (known != pictures_.end()) return known->second;
    std::shared_ptr<const image::ImageFile> picture;
    if (!opens_) return pictures_[path] = picture;
    if (auto read = reading_.read(path))
      picture = std::make_shared<const image::ImageFile>(*std::move(read));
    else
      note(read.error().what + "; its colours are left out");
    pictures_[path] = picture;
    return picture;
  }

  std::map<std::string, std::size_t, std::less<>> numbers_;  // index of each material, by name
  CompanionFinder files_;
  std::vector<std::string>& notes_;
  std::size_t noted_ = 0;
  std::vector<ObjMaterial> materials_;
  bool opens_;
  TexturePictures reading_;
  std::map<std::string, std::shared_ptr<const image::ImageFile>> pictures_;
};

constexpr std::size_t kMostLibraries = 64;

// Reads the first kMostLibraries different libraries. Returns whether these were all.
bool readAll(const std::vector<std::string>& libraries, Library& library) {
  std::set<std::string_view> named;
  for (const std::string& name : libraries) {
    if (named.insert(name).second && named.size() <= kMostLibraries) library.read(name);
  }
  return named.size() <= kMostLibraries;
}

}  // namespace

std::vector<ObjMaterial> readMaterials(const std::vector<std::string>& names,
                                       const std::vector<std::string>& libraries,
                                       const std::string& folder, std::vector<std::string>& notes) {
  Library library(names, folder, notes, true);
  if (!readAll(libraries, library))
    notes.push_back(fmt::format("only the first {} material libraries are read", kMostLibraries));
  return library.take();
}

std::vector<std::string> picturesOf(const std::vector<std::string>& names,
                                    const std::vector<std::string>& libraries,
                                    const std::string& folder) {
  std::vector<std::string> notes;
  Library library(names, folder, notes, false);
  readAll(libraries, library);
  return library.paths();
}

}  // namespace merlin::render::mesh
