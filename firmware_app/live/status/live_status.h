#pragma once

#include <atomic>
#include <string>

#include "firmware_app/live/live_controls.h"
#include "firmware_app/live/live_job.h"
#include "firmware_app/live/status/machine_health.h"
#include "firmware_app/status_server/status_server.h"
#include "hal/clock.h"
#include "pipeline/runtime/live_pipeline.h"
#include "pipeline/runtime/status/runtime_status.h"

namespace pleinair::app {

/// The state of a live painting, for its status server, a service manager and the log. Any thread,
/// unless said otherwise.
class LiveStatus {
 public:
  /// All references outlive this.
  LiveStatus(const LiveJob& job, runtime::LivePipeline& pipeline, const LiveControls& controls,
             const MachineHealth& health);

  /// The uptime begins. Before another thread asks.
  void begin(hal::TimePoint now) { began_ = now; }
  /// Outputs and paint stage exist from now on.
  void setComplete() { isComplete_.store(true, std::memory_order_release); }

  /// Null until it is complete.
  runtime::LivePipeline* pipeline() const {
    return isComplete_.load(std::memory_order_acquire) ? &pipeline_ : nullptr;
  }
  /// Before the camera's first frame there are neither outputs nor a painter.
  runtime::RuntimeStatus now() const;
  /// The pages that the status server answers with; valid as long as this is.
  StatusPages pages() const;

 private:
  runtime::RuntimeStatus ofPipeline() const;
  std::string thumbnail() const;

  const LiveJob& job_;
  runtime::LivePipeline& pipeline_;
  const LiveControls& controls_;
  const MachineHealth& health_;
  hal::TimePoint began_;
  std::atomic<bool> isComplete_ = false;
};

}  // namespace pleinair::app
