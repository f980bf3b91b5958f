// SlotTable: finds the slots of a segment by their names, in the segment's table of fields.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/shm/fields.h"

namespace merlin::shm {

// Place of the table of fields in a segment, as the header states it: `offset` from the segment's
// start and `field_size` of an entry in bytes, `count` of entries.
struct TablePlace {
  std::uint32_t offset, count, field_size;

  // Whether the table lies inside a segment of this size [bytes] and its entries are at least as
  // long as Field. A table without entries always fits.
  bool fits(std::size_t segment_size) const noexcept;
};

// A reader that finds its slots with a SlotTable depends neither on their offsets nor on which
// other slots the segment has. A slot is checked when it is looked up, so each slot should be
// looked up once, when the segment is opened; reading it afterwards needs no check. Reentrant.
class SlotTable {
 public:
  // Copies the table of fields of a segment. `segment`: all bytes of the segment; they must stay
  // mapped as long as the pointers that this object returns are used. `name`: the segment's name,
  // for messages. Errors: kMalformed (the table is not inside the segment). REQUIRES: the segment
  // is at least as large as Header.
  static Result<SlotTable> read(std::span<const std::byte> segment, std::string name);

  // Returns the channel or the slot with this name, such as "glove" or "glove.health". T is the
  // type of its value, one for which fields.cpp instantiates channelFields() or slotFields().
  // Errors, whose text names segment and slot: kUnsupported (there is no such slot), kMalformed
  // (its fields are not those of T, or it is not inside the segment). Cost: one look-up per field
  // of T.
  template <typename T>
  Result<const Channel<T>*> channel(const std::string& slot) const {
    return typed<Channel<T>>(slot, channelFields<T>);
  }
  template <typename T>
  Result<const SeqSlot<T>*> slot(const std::string& slot) const {
    return typed<SeqSlot<T>>(slot, slotFields<T>);
  }

  // Returns the field names that end with `ending`, with that ending removed, in the order of the
  // table: {"glove", "tracker", ...} for ".health.state".
  std::vector<std::string> namesBefore(std::string_view ending) const;

 private:
  // Returns the fields that a slot of one type has if it has this name and is at this offset.
  using Describe = std::vector<Field> (*)(const std::string& name, std::size_t offset);

  SlotTable(std::span<const std::byte> segment, std::string name)
      : segment_(segment), name_(std::move(name)) {}

  template <typename Slot>
  Result<const Slot*> typed(const std::string& slot, Describe describe) const {
    const auto offset = locate(slot, describe, sizeof(Slot), alignof(Slot));
    if (!offset) return offset.error();
    return reinterpret_cast<const Slot*>(segment_.data() + *offset);
  }
  // Returns the offset of the slot from the segment's start [bytes], after checking its fields, its
  // size and its alignment.
  Result<std::size_t> locate(const std::string& slot, Describe describe, std::size_t size,
                             std::size_t alignment) const;
  Error malformed(const std::string& slot, const std::string& what) const;
  const Field* find(const char* field) const;

  std::span<const std::byte> segment_;
  std::string name_;
  std::vector<std::string> names_;  // names of the fields, in the order of the table
  std::map<std::string, Field, std::less<>> fields_;
};

}  // namespace merlin::shm
