#pragma once

#include <array>

#include "pipeline/gpu/gl.h"

namespace pleinair::gpu {

/// For work in a context that belongs to somebody else. While it lives, what our passes rely on is
/// as in a new context, whatever the host had set; when it goes, what they bind or switch is as in
/// a new context again, and the viewport is the host's. On the thread of the context.
class HostState {
 public:
  HostState();
  ~HostState();
  HostState(const HostState&) = delete;
  HostState& operator=(const HostState&) = delete;

 private:
  std::array<GLint, 4> viewport_{};
};

}  // namespace pleinair::gpu
