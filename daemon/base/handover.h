// Handover: passes a value to another thread, which takes it at a time of its choice, without
// locking, allocating or freeing anything.
#pragma once

#include <atomic>
#include <memory>
#include <utility>

namespace merlin {

// One thread calls offer(), another one calls take(). The previous value of the taking thread is
// freed by the next offer(), on the offering thread.
template <typename T>
class Handover {
 public:
  Handover() = default;
  ~Handover() {
    delete offered_.load();
    free(given_back_.load());
  }
  Handover(const Handover&) = delete;
  Handover& operator=(const Handover&) = delete;

  // Offers a value, which replaces an offered one that was not taken yet.
  void offer(T value) {
    auto fresh = std::make_unique<Node>(Node{std::move(value), nullptr});
    delete offered_.exchange(fresh.release(), std::memory_order_acq_rel);
    free(given_back_.exchange(nullptr, std::memory_order_acquire));
  }

  // If a value was offered, calls merge(mine, offered), swaps the two and returns true; otherwise
  // returns false.
  template <typename Merge>
  bool take(T& mine, const Merge& merge) noexcept {
    if (!offered_.load(std::memory_order_relaxed)) return false;
    Node* const node = offered_.exchange(nullptr, std::memory_order_acq_rel);
    if (!node) return false;
    merge(mine, node->value);
    std::swap(mine, node->value);
    node->next = given_back_.load(std::memory_order_relaxed);
    while (!given_back_.compare_exchange_weak(node->next, node, std::memory_order_release,
                                              std::memory_order_relaxed)) {
    }
    return true;
  }
  bool take(T& mine) noexcept {
    return take(mine, [](T&, T&) {});
  }

 private:
  struct Node {
    T value;
    Node* next;  // in the list given_back_
  };
  static void free(Node* node) noexcept {
    while (node) delete std::exchange(node, node->next);
  }

  std::atomic<Node*> offered_{nullptr};
  // A list of all nodes given back since the last offer. If it had room for only one, a taker that
  // gave one back just after the last offer could never take that offer.
  std::atomic<Node*> given_back_{nullptr};
};

}  // namespace merlin
