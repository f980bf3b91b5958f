#include "daemon/net/server_thread.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <utility>

namespace merlin::net {
namespace {

// Waits until the thread is asked to stop.
void idle(const std::stop_token& stop, Progress& progress) {
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  while (!stop.stop_requested()) {
    progress.step();
    stopped.wait_for(lock, stop, std::chrono::milliseconds(500), [] { return false; });
  }
}

}  // namespace

ServerThread::ServerThread(ThreadWatch& threads, std::string name, std::function<void()> round)
    : state_(std::make_shared<State>()),
      thread_(threads, std::move(name),
              [state = state_, round = std::move(round)](const std::stop_token& stop,
                                                         Progress& progress) {
                try {
                  while (!stop.stop_requested()) {
                    progress.step();
                    round();
                  }
                } catch (const std::exception& e) {
                  const std::lock_guard lock(state->mutex);
                  state->failure = std::string("its thread ended: ") + e.what();
                }
                idle(stop, progress);  // the owner checks failure() and stops the thread
              }) {}

std::string ServerThread::failure() const {
  if (!state_) return {};
  const std::lock_guard lock(state_->mutex);
  return state_->failure;
}

}  // namespace merlin::net
