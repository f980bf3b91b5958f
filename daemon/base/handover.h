// Handover: gives a value to another thread, which swaps it in when it likes, without a lock and
// without allocating or freeing anything.
#pragma once

#include <atomic>
#include <memory>
#include <utility>

namespace merlin {

// One thread offers, one takes. What the taker had before is freed by the offering thread, with the
// next offer().
template <typename T>
class Handover {
 public:
  Handover() = default;
  ~Handover() {
    delete offered_.load();
    delete given_back_.load();
  }
  Handover(const Handover&) = delete;
  Handover& operator=(const Handover&) = delete;

  // Offers a value in place of one that was not taken yet.
  void offer(T value) {
    auto fresh = std::make_unique<T>(std::move(value));
    delete offered_.exchange(fresh.release(), std::memory_order_acq_rel);
    // After the exchange, since the taker waits while there is one: so none is overwritten.
    delete given_back_.exchange(nullptr, std::memory_order_acq_rel);
  }

  // Swaps the offered value with `mine`, after merge(mine, offered); false if there is none.
  template <typename Merge>
  bool take(T& mine, const Merge& merge) noexcept {
    if (!offered_.load(std::memory_order_relaxed) || given_back_.load(std::memory_order_acquire))
      return false;
    T* const fresh = offered_.exchange(nullptr, std::memory_order_acq_rel);
    if (!fresh) return false;
    merge(mine, *fresh);
    std::swap(mine, *fresh);
    given_back_.store(fresh, std::memory_order_release);
    return true;
  }
  bool take(T& mine) noexcept {
    return take(mine, [](T&, T&) {});
  }

 private:
  std::atomic<T*> offered_{nullptr};
  std::atomic<T*> given_back_{nullptr};
};

}  // namespace merlin
