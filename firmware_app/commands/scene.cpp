#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "firmware_app/cli/counted_text.h"
#include "firmware_app/cli/exit_status.h"
#include "firmware_app/cli/interrupt.h"
#include "firmware_app/cli/path_collisions.h"
#include "firmware_app/cli/progress.h"
#include "firmware_app/cli/standard_streams.h"
#include "firmware_app/commands/commands.h"
#include "firmware_app/config/configured_parts.h"
#include "firmware_app/scene/scene_check.h"
#include "firmware_app/scene/scene_observer.h"
#include "firmware_app/scene/scene_warnings.h"
#include "hal/cameras/recording/recording.h"
#include "hal/media/png_file.h"
#include "hal/pending_file.h"
#include "pipeline/engine/painter.h"
#include "pipeline/present/contact_sheet.h"

namespace pleinair::app {
namespace {

using hal::orThrow;

/// A frame that is not as large as the scene's calibration is refused by the painter.
tracking::CameraModel cameraOf(const scene::Scene& scene, hal::FrameSize frame) {
  return scene.camera ? *scene.camera : scene::assumedCamera(frame);
}

/// Tracks a recording and draws what the scene says over some of its frames.
class SceneFilm {
 public:
  SceneFilm(const scene::Scene& scene, const SceneCheckOptions& options)
      : scene_(scene),
        camera_(hal::openRecording(*options.input, clock_)),
        stream_(orThrow(camera_->start({}))),
        file_(orThrow(hal::PendingFile::create(*options.output))),
        painter_({.pictureSize = stream_.frame.size,
                  .scene = scene,
                  .style = "none",
                  .expectedFormat = stream_.frame,
                  .isCancelled = [] { return Interrupt::received() != 0; }}),
        observer_(scene) {}

  /// Gives the signal that interrupted it, or 0.
  int run() {
    Progress progress("checking", stream_.frameCount, realTime_);
    for (;;) {
      if (const int signal = Interrupt::received(); signal != 0) return signal;
      hal::NextFrame next = camera_->next(hal::kNoDeadline);
      if (auto* error = std::get_if<hal::Error>(&next)) throw hal::Failure(std::move(*error));
      if (std::holds_alternative<hal::EndOfStream>(next)) break;
      if (const auto* frame = std::get_if<hal::CapturedFrame>(&next)) {
        check(*frame);
        progress.advance();
      }
    }
    orThrow(file_.write(orThrow(hal::encodePng(sheet_.sheet().view()))));
    orThrow(file_.publish());
    return 0;
  }

  const SceneObserver& observer() const { return observer_; }
  hal::FrameSize frameSize() const { return stream_.frame.size; }

 private:
  void check(const hal::CapturedFrame& frame) {
    if (!firstTime_) firstTime_ = frame.captureTime;
    const Picture picture = orThrow(painter_.paint(frame, painter_.defaultParameters()));
    const bool isWanted = sheet_.wants(observer_.frames());
    observer_.take(frame.image.map().view(), picture.tracking);
    if (!isWanted) return;
    const hal::Image original = orThrow(painter_.cameraSnapshot());
    hal::Image drawn = orThrow(painter_.snapshot());
    // A frame of another size than the first fills the picture, where nothing can be drawn at its
    // place.
    if (frame.image.format.size == drawn.size()) {
      drawSceneCheck(drawn, scene_, cameraOf(scene_, drawn.size()), picture.tracking);
    }
    sheet_.add(original.view(), drawn.view(), frame.captureTime - *firstTime_);
  }

  const scene::Scene& scene_;
  hal::SteppedClock clock_;
  hal::SteadyClock realTime_;  // for the progress line
  std::unique_ptr<hal::Camera> camera_;
  hal::StreamFormat stream_;
  hal::PendingFile file_;
  Painter painter_;
  SceneObserver observer_;
  std::optional<hal::TimePoint> firstTime_;
  present::ContactSheet sheet_;
};

void describeScene(const scene::Scene& scene, const SceneObserver* observer) {
  std::string text = fmt::format("{} of {}, {}\n", countedText(scene.tags.size(), "tag"),
                                 scene.tagFamily, countedText(scene.models.size(), "model"));
  for (const tracking::TagMarker& tag : scene.tags) {
    text += fmt::format("  tag {}: {:g} m{}", tag.id, tag.edgeMetres,
                        tag.worldFromTag ? ", has a place in the world" : "");
    if (observer != nullptr) {
      text += fmt::format("; seen in {} of {}", observer->sightings(tag.id),
                          countedText(observer->frames(), "frame"));
    }
    text += "\n";
  }
  for (const std::string& line : modelLines(scene)) text += "  " + line + "\n";
  writeText(stdout, text);
}

}  // namespace

int checkScene(const SceneCheckOptions& options) {
  const Interrupt interrupt;
  const scene::Scene scene = sceneOfFile(options.scene);
  std::vector<NamedPath> read{{"FILE", options.scene}};
  for (const auto& file : scene.files) read.push_back({"a file of the scene", file});
  if (options.input) read.push_back({"--input", *options.input});
  if (options.output) refuseCollisions(read, {{"--output", *options.output}});
  std::vector<std::string> findings = scene.notices;
  for (std::string& each : placementFindings(scene)) findings.push_back(std::move(each));
  if (options.input) {
    SceneFilm film(scene, options);
    if (const int signal = film.run(); signal != 0) {
      printError(fmt::format("interrupted by {}; nothing was written", signalName(signal)));
      return kSignalExitBase + signal;
    }
    if (auto assumed = assumedCameraWarning(scene, film.frameSize())) {
      spdlog::warn("{}", *assumed);  // no mistake
    }
    for (std::string& each : film.observer().findings()) findings.push_back(std::move(each));
    describeScene(scene, &film.observer());
  } else {
    describeScene(scene, nullptr);
  }
  for (const std::string& finding : findings) spdlog::warn("{}", finding);
  return findings.empty() ? 0 : static_cast<int>(ExitStatus::kInternal);
}

}  // namespace pleinair::app
