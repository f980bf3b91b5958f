// DrawTimer: measures how long the GPU takes for the commands between begin() and end().
#pragma once

#include <utility>

#include "daemon/base/clock.h"
#include "render/gl/gl_api.h"

namespace merlin::render::gl {

// Thread-bound to its context, which must outlive it. Only one timer of a context may be between
// begin() and end().
class DrawTimer {
 public:
  explicit DrawTimer(const GlApi& gl) : gl_(&gl) { gl.GenQueries(1, &query_); }
  DrawTimer(DrawTimer&& other) noexcept : gl_(other.gl_), query_(std::exchange(other.query_, 0)) {}
  DrawTimer& operator=(DrawTimer&&) = delete;
  DrawTimer(const DrawTimer&) = delete;
  DrawTimer& operator=(const DrawTimer&) = delete;
  ~DrawTimer() {
    if (query_) gl_->DeleteQueries(1, &query_);
  }

  void begin() const { gl_->BeginQuery(GL_TIME_ELAPSED, query_); }
  void end() const { gl_->EndQuery(GL_TIME_ELAPSED); }

  // Waits until the GPU has done what was given to it between begin() and end(), and returns how
  // long that took. REQUIRES: both were called.
  Duration elapsed() const {
    GLuint64 ns = 0;
    gl_->GetQueryObjectui64v(query_, GL_QUERY_RESULT, &ns);
    return Duration(static_cast<std::int64_t>(ns));
  }

 private:
  const GlApi* gl_;
  GLuint query_ = 0;
};

}  // namespace merlin::render::gl
