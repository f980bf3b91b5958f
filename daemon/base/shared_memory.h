// SharedMemory: one POSIX shared-memory object, owned by its writer or mapped by a reader.
#pragma once

#include <cstddef>
#include <string>
#include <utility>

#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin {

class SharedMemory {
 public:
  // A new object of `size` zero bytes under `name` ("/merlin-wall"), owned for as long as this
  // lives; what a dead owner left under the name is replaced. Ownership is a lock on the object
  // NAME.lock, which only the owner's user may open: no reader can hold it. Pages are there from
  // the start, so that no later write can fault for want of memory. Errors: kBusy (a living process
  // owns it), kIo (also where another user's object has the name).
  static Result<SharedMemory> create(const std::string& name, std::size_t size);

  // Whose object a reader takes. A daemon that steers by what it reads takes its own user's or
  // root's alone: anybody may make an object of a name that nobody has.
  enum class From { kAnyone, kOwnUserOrRoot };

  // What another process made, read-only. Errors: kNotFound, kIo (with the group to join where it
  // may not be read; another user's), kMalformed (empty). Who may write the object can cut it
  // short, which ends a reader that touches it with SIGBUS: that is its owner and root alone.
  static Result<SharedMemory> open(const std::string& name, From from = From::kAnyone);

  // For the owner, once a second, from one thread: where the object or its lock was removed or
  // replaced, it is made again, with the same bytes at the same address. What a thread was writing
  // at that moment may be lost or torn until it is written again. Returns what had happened, a
  // sentence; empty: nothing. Errors: it cannot be made again (another process took the name, no
  // memory); then ours goes on without a name. Cost: three calls of the kernel.
  Result<std::string> mend();

  // True where a living process of this user owns the object of that name.
  static bool owned(const std::string& name);

  SharedMemory() = default;
  SharedMemory(SharedMemory&& other) noexcept;
  SharedMemory& operator=(SharedMemory&& other) noexcept;
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  ~SharedMemory();  // unmaps; the owner also removes the name

  std::byte* data() const noexcept { return data_; }
  std::size_t size() const noexcept { return size_; }

 private:
  SharedMemory(UniqueFd lock, UniqueFd object, std::byte* data, std::size_t size,
               std::string owned_name)
      : lock_(std::move(lock)),
        object_(std::move(object)),
        data_(data),
        size_(size),
        owned_name_(std::move(owned_name)) {}
  Result<Ok> remake();

  UniqueFd lock_, object_;  // of an owner
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  std::string owned_name_;  // empty for a reader
};

}  // namespace merlin
