// ShownPictures: the small pictures of contents that are not in the configuration, kept as the wall
// showed them. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace merlin::page {

// Thread-bound.
class ShownPictures {
 public:
  struct Picture {
    std::string name;
    std::shared_ptr<const std::string> jpeg;
    std::uint64_t number = 0;  // differs from that of every picture before it
  };

  // Takes the picture as the newest of the content. Of more than kMost contents the one whose
  // picture is the oldest is forgotten. Returns false if the picture is the same as before.
  bool keep(const std::string& name, std::string jpeg, std::uint64_t number);

  // In the order of their places, which stay.
  const std::vector<Picture>& all() const noexcept { return pictures_; }

  static constexpr std::size_t kMost = 50;  // as many names as the wall lists

 private:
  std::vector<Picture> pictures_;
};

}  // namespace merlin::page
