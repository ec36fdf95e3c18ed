#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "hal/pixel_format.h"

namespace pleinair::gpu {

/// What is allocated for pictures of one size, kept for each size that was asked for: levels of
/// quality come back, and nothing is to be allocated then. May be declared of an incomplete T.
template <class T>
class PerSize {
 public:
  /// That of this size; where there is none yet, it is made as T(args…). Valid until clear().
  template <class... Args>
  T& of(hal::FrameSize size, const Args&... args) {
    const auto known = std::ranges::find(all_, size, &Entry::first);
    if (known != all_.end()) return *known->second;
    return *all_.emplace_back(size, std::make_unique<T>(args...)).second;
  }
  void clear() { all_.clear(); }

 private:
  using Entry = std::pair<hal::FrameSize, std::unique_ptr<T>>;
  std::vector<Entry> all_;
};

}  // namespace pleinair::gpu
