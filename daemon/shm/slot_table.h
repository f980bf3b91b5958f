// SlotTable: finds the slots of a segment by their names, through the segment's table of fields.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/shm/fields.h"

namespace merlin::shm {

// Position of the table of fields, as the segment's header states it.
struct TablePlace {
  std::uint32_t offset, count, field_size;

  // Whether the table is inside a segment of that size [bytes], and its entries are at least as
  // long as Field.
  bool fits(std::size_t segment_size) const noexcept;
};

// A reader that finds its slots with a SlotTable depends neither on their offsets nor on which
// other slots the segment has. Each slot is checked when it is looked up, which is meant to be done
// once, when the segment is opened; reading it afterwards costs no check. Reentrant.
class SlotTable {
 public:
  // Copies the table of a segment. `segment`: all its bytes; they must outlive the pointers that
  // this object returns. `name`: the segment's name, for messages. Errors: kMalformed (the table
  // is not inside the segment). REQUIRES: the segment has room for its Header.
  static Result<SlotTable> read(std::span<const std::byte> segment, std::string name);

  // The channel, or the slot, with that name: "glove", "glove.health". T is a type for which
  // fields.h describes a slot. Errors, with the names of segment and slot: kUnsupported (there is
  // no such slot), kMalformed (its fields or its size are not those of a T, or it is not inside the
  // segment). Cost: a look-up per field of T.
  template <typename T>
  Result<const Channel<T>*> channel(const std::string& slot) const {
    return typed<Channel<T>>(slot, channelFields<T>);
  }
  template <typename T>
  Result<const SeqSlot<T>*> slot(const std::string& slot) const {
    return typed<SeqSlot<T>>(slot, slotFields<T>);
  }

  // The names in the table that have this ending, without it, in the table's order:
  // {"glove", "tracker", ...} for ".health.state".
  std::vector<std::string> namesBefore(std::string_view ending) const;

 private:
  // The fields of a slot of one type, if it has this name and is at this offset.
  using Describe = std::vector<Field> (*)(const std::string& name, std::size_t offset);

  SlotTable(std::span<const std::byte> segment, std::string name)
      : segment_(segment), name_(std::move(name)) {}

  template <typename Slot>
  Result<const Slot*> typed(const std::string& slot, Describe describe) const {
    const auto offset = locate(slot, describe, sizeof(Slot), alignof(Slot));
    if (!offset) return offset.error();
    return reinterpret_cast<const Slot*>(segment_.data() + *offset);
  }
  // Offset of the slot in the segment.
  Result<std::size_t> locate(const std::string& slot, Describe describe, std::size_t size,
                             std::size_t alignment) const;
  Error malformed(const std::string& slot, const std::string& what) const;
  const Field* find(const char* field) const;

  std::span<const std::byte> segment_;
  std::string name_;
  std::vector<std::string> names_;  // of the fields, in the table's order
  std::map<std::string, Field, std::less<>> fields_;
};

}  // namespace merlin::shm
