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
  // Creates an object of `size` zero bytes under `name` ("/merlin-wall"), owned until this is
  // destroyed; an object that a dead owner left under the name is replaced. Ownership is a lock on
  // the object NAME.lock, which only the owner's user may open, so that no reader can hold it. All
  // pages are allocated at once, so that no later write can fail for lack of memory. Errors: kBusy
  // (a running process owns it), kIo (also if another user's object has the name).
  static Result<SharedMemory> create(const std::string& name, std::size_t size);

  // The owners whose objects a reader accepts. A daemon that acts on what it reads must accept only
  // objects of its own user or root, because anybody may create an object under a free name.
  // kOwnGroup, for a daemon that runs as another user: also objects that belong to a group of this
  // process, since only a member of the group can have created them.
  enum class From { kAnyone, kOwnUserOrRoot, kOwnGroup };

  // Maps another process' object read-only. Errors: kNotFound, kIo (no permission: the message
  // names the group to join; or `from` does not accept its owner), kMalformed (empty). The object's
  // owner and root, who may write it, can also truncate it, which ends readers with SIGBUS.
  static Result<SharedMemory> open(const std::string& name, From from = From::kAnyone);

  // To be called by the owner once a second, from one thread: if the object or its lock was removed
  // or replaced, creates it again, with the same bytes at the same address. A value that a thread
  // writes at that moment may be lost or torn until it is written again. Returns a sentence about
  // what was created again; empty if nothing was. Errors: it cannot be created again (another
  // process took the name, no memory); the mapping then continues without a name. Cost: three
  // system calls.
  Result<std::string> mend();

  // Whether a running process of this user owns the object of that name.
  static bool owned(const std::string& name);

  SharedMemory() = default;
  SharedMemory(SharedMemory&& other) noexcept;
  SharedMemory& operator=(SharedMemory&& other) noexcept;
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  ~SharedMemory();  // unmaps; the owner also removes the object's name

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

  UniqueFd lock_, object_;  // for an owner only
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  std::string owned_name_;  // empty for a reader
};

}  // namespace merlin
