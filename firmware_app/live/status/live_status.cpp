#include "firmware_app/live/status/live_status.h"

#include <optional>

#include "firmware_app/live/status/status_page.h"
#include "firmware_app/live/status/thumbnail.h"
#include "pipeline/engine/painter.h"
#include "pipeline/runtime/status/status_text.h"

namespace pleinair::app {

LiveStatus::LiveStatus(const LiveJob& job, runtime::LivePipeline& pipeline,
                       const LiveControls& controls, const MachineHealth& health)
    : job_(job), pipeline_(pipeline), controls_(controls), health_(health) {}

runtime::RuntimeStatus LiveStatus::now() const {
  runtime::RuntimeStatus status = ofPipeline();
  status.machine = health_.state();
  status.siteOrigin = job_.siteOrigin;
  status.siteProblem = job_.standingText;
  if (job_.procedure != nullptr) status.procedure = job_.procedure->status();
  return status;
}

runtime::RuntimeStatus LiveStatus::ofPipeline() const {
  if (pipeline() != nullptr) return pipeline_.status();
  runtime::RuntimeStatus status{.uptime = job_.clock->now() - began_,
                                .camera = pipeline_.capture().status(),
                                .painting = {},
                                .outputs = {},
                                .ledger = pipeline_.ledger().counts()};
  const std::optional<hal::Error>& cause = status.camera.cause;
  status.camera.reason =
      "waiting for a camera: " + (cause ? cause->message() : status.camera.reason);
  return status;
}

StatusPages LiveStatus::pages() const {
  return {
      .page = [this] { return statusPage(now(), controls_.parameters()->style, qualityNames()); },
      .picture = [this] { return thumbnail(); },
      .json = [this] { return runtime::statusJson(now(), qualityNames()); },
      .metrics = [this] { return runtime::statusMetrics(now(), qualityNames()); },
      .healthy = [this] { return now().isHealthy(); }};
}

/// A small picture of what the first output shows, as a JPEG; empty where there is none yet. The
/// server's thread.
std::string LiveStatus::thumbnail() const {
  if (pipeline() == nullptr) return {};
  for (std::size_t i = 0; i < pipeline_.outputCount(); ++i) {
    const runtime::OutputStage& output = pipeline_.output(i);
    if (const auto frame = output.lastFrame()) {
      return hal::orThrow(thumbnailJpeg(*frame, output.format().quarterTurns));
    }
  }
  return {};
}

}  // namespace pleinair::app
