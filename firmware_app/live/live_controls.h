#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "hal/error.h"
#include "hal/image.h"
#include "pipeline/engine/painter.h"

namespace pleinair::app {

/// Requests of the main thread to the paint thread, and the snapshots that come back. Any thread.
class LiveControls {
 public:
  explicit LiveControls(PaintParameters parameters) { setParameters(std::move(parameters)); }

  /// Replaces the parameter set, from the next frame on.
  void setParameters(PaintParameters parameters) {
    auto next = std::make_shared<const PaintParameters>(std::move(parameters));
    const std::scoped_lock lock(mutex_);
    parameters_ = std::move(next);
  }
  std::shared_ptr<const PaintParameters> parameters() const {
    const std::scoped_lock lock(mutex_);
    return parameters_;
  }

  /// Requests a snapshot of the next frame.
  void requestSnapshot() {
    const std::scoped_lock lock(mutex_);
    wantsSnapshot_ = true;
  }
  bool takeSnapshotRequest() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(wantsSnapshot_, false);
  }
  void putSnapshot(hal::Result<hal::Image> snapshot) {
    const std::scoped_lock lock(mutex_);
    snapshot_ = std::move(snapshot);
  }
  std::optional<hal::Result<hal::Image>> takeSnapshot() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(snapshot_, std::nullopt);
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const PaintParameters> parameters_;
  bool wantsSnapshot_ = false;
  std::optional<hal::Result<hal::Image>> snapshot_;
};

}  // namespace pleinair::app
