// ModelFolder: gives assimp access to the model and its companion files, and to no other file.
#pragma once

#include <string>

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>

#include "render/import/model_file.h"

namespace merlin::render::import {

// A read-only file system for assimp. It shows the model under a name whose ending matches its
// format, and the companion files in the model's folder or below (companion_path.h). `file` must
// outlive it.
class ModelFolder final : public Assimp::IOSystem {
 public:
  explicit ModelFolder(const ModelFile& file);

  const std::string& name() const noexcept { return name_; }

  bool Exists(const char* name) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override;
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::string pathOf(const char* name) const;

  const ModelFile& file_;
  std::string name_, folder_;
};

}  // namespace merlin::render::import
