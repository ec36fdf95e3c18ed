#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "hal/pixel_format.h"

namespace pleinair::gpu {

/// The allocations for images of one size, kept for each size that was asked for: when a level of
/// quality comes back, nothing is allocated. May be declared of an incomplete T.
template <class T>
class PerSize {
 public:
  /// Returns the entry of this size; the first call for a size makes it as T(args…). Valid until
  /// clear().
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
