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

  // Swaps the offered value with `mine`, after merge(mine, offered); false if there is none.
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
