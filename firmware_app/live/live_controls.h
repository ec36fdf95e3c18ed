#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "hal/error.h"
#include "hal/image.h"
#include "pipeline/engine/painter.h"

namespace pleinair::app {

/// What whoever operates a live painting asks of the painter's thread, and what comes back.
/// Thread-safe.
class LiveControls {
 public:
  explicit LiveControls(PaintParameters parameters) { setParameters(std::move(parameters)); }

  /// One snapshot, in force from the next frame on.
  void setParameters(PaintParameters parameters) {
    auto snapshot = std::make_shared<const PaintParameters>(std::move(parameters));
    const std::scoped_lock lock(mutex_);
    parameters_ = std::move(snapshot);
  }
  std::shared_ptr<const PaintParameters> parameters() const {
    const std::scoped_lock lock(mutex_);
    return parameters_;
  }

  /// The next frame is to be kept as a still.
  void requestSnapshot() {
    const std::scoped_lock lock(mutex_);
    wantsSnapshot_ = true;
  }
  bool takeSnapshotRequest() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(wantsSnapshot_, false);
  }
  void putSnapshot(hal::Result<hal::Image> still) {
    const std::scoped_lock lock(mutex_);
    still_ = std::move(still);
  }
  std::optional<hal::Result<hal::Image>> takeSnapshot() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(still_, std::nullopt);
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const PaintParameters> parameters_;
  bool wantsSnapshot_ = false;
  std::optional<hal::Result<hal::Image>> still_;
};

}  // namespace pleinair::app
