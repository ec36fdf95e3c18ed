#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "firmware_app/repair_station/seen_tags.h"
#include "hal/error.h"
#include "hal/image.h"
#include "pipeline/engine/painter.h"
#include "pipeline/inspection/template_file.h"

namespace pleinair::app {

/// The camera's part of a frame, and where the machine is in it, if its tags are seen.
struct CameraStill {
  hal::Result<hal::Image> image;
  std::optional<inspection::TemplatePose> place;
};

/// The parameters of the next frame, with the style that they are of.
struct LiveParameters {
  std::string style;
  PaintParameters painting;
};

/// Requests of the main thread to the paint thread, and the snapshots that come back. Any thread.
class LiveControls {
 public:
  explicit LiveControls(LiveParameters parameters) { setParameters(std::move(parameters)); }

  /// Replaces the parameter set, from the next frame on. Another style needs another painter
  /// (runtime::PaintStage::renew()).
  void setParameters(LiveParameters parameters) {
    auto next = std::make_shared<const LiveParameters>(std::move(parameters));
    const std::scoped_lock lock(mutex_);
    parameters_ = std::move(next);
  }
  std::shared_ptr<const LiveParameters> parameters() const {
    const std::scoped_lock lock(mutex_);
    return parameters_;
  }

  /// Replaces what is drawn over the painting, from the next frame on; null: nothing.
  void setOverlay(std::shared_ptr<const overlay::OverlayContent> content) {
    const std::scoped_lock lock(mutex_);
    overlay_.swap(content);
  }
  std::shared_ptr<const overlay::OverlayContent> overlay() const {
    const std::scoped_lock lock(mutex_);
    return overlay_;
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

  /// Requests the camera's part of the next frame, unpainted: a still for a record.
  void requestStill() {
    const std::scoped_lock lock(mutex_);
    wantsStill_ = true;
  }
  bool takeStillRequest() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(wantsStill_, false);
  }
  void putStill(CameraStill still) {
    const std::scoped_lock lock(mutex_);
    still_ = std::move(still);
  }
  std::optional<CameraStill> takeStill() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(still_, std::nullopt);
  }

  /// The tags of the last painted frame.
  void putTags(const SeenTags& tags) {
    const std::scoped_lock lock(mutex_);
    tags_ = tags;
  }
  std::optional<SeenTags> takeTags() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(tags_, std::nullopt);
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const LiveParameters> parameters_;
  std::shared_ptr<const overlay::OverlayContent> overlay_;
  bool wantsSnapshot_ = false;
  std::optional<hal::Result<hal::Image>> snapshot_;
  bool wantsStill_ = false;
  std::optional<CameraStill> still_;
  std::optional<SeenTags> tags_;
};

}  // namespace pleinair::app
