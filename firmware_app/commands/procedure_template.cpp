#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "firmware_app/cli/interrupt.h"
#include "firmware_app/cli/path_collisions.h"
#include "firmware_app/cli/progress.h"
#include "firmware_app/cli/standard_streams.h"
#include "firmware_app/commands/procedure.h"
#include "firmware_app/repair_station/seen_tags.h"
#include "hal/cameras/recording/recording.h"
#include "hal/media/png_file.h"
#include "hal/pending_file.h"
#include "pipeline/engine/painter.h"
#include "pipeline/inspection/template_file.h"
#include "pipeline/scene/description/scene_file.h"

namespace pleinair::app {
namespace {

using hal::orThrow;

/// The frame of a recording in which the machine is located best, as a template.
class BestFrame {
 public:
  BestFrame(const scene::Scene& scene, const MachinePlace& place,
            const std::filesystem::path& input)
      : scene_(scene),
        place_(place),
        camera_(hal::openRecording(input, clock_)),
        stream_(orThrow(camera_->start({}))),
        painter_({.pictureSize = stream_.frame.size,
                  .scene = scene,
                  .style = "none",
                  .expectedFormat = stream_.frame,
                  .isCancelled = [] { return Interrupt::received() != 0; }}) {}

  /// Gives the signal that interrupted it, or 0.
  int find() {
    Progress progress("locating", stream_.frameCount, realTime_);
    for (;;) {
      if (const int signal = Interrupt::received(); signal != 0) return signal;
      hal::NextFrame next = camera_->next(hal::kNoDeadline);
      if (auto* error = std::get_if<hal::Error>(&next)) throw hal::Failure(std::move(*error));
      if (std::holds_alternative<hal::EndOfStream>(next)) return 0;
      if (const auto* frame = std::get_if<hal::CapturedFrame>(&next)) {
        look(*frame);
        progress.advance();
      }
    }
  }

  const std::optional<inspection::TemplatePose>& pose() const { return pose_; }
  const hal::Image& picture() const { return picture_; }
  double sigmaMillimetres() const { return sigma_; }

 private:
  void look(const hal::CapturedFrame& frame) {
    const Picture painted = orThrow(painter_.paint(frame, painter_.defaultParameters()));
    const auto machine = cameraFromMachine(place_, painted.tracking);
    if (!machine) return;
    const hal::FrameSize size = frame.image.format.size;
    const auto quality = poseQualityOf(place_, seenTagsOf(painted.tracking, size, {}));
    const double sigma = quality->sigmaMillimetres.value_or(0.0);
    if (pose_ && sigma >= sigma_) return;
    const tracking::CameraModel camera =
        scene_.camera ? *scene_.camera : scene::assumedCamera(size);
    pose_ = {.camera = scene::fittedCamera(camera, stream_.frame.size),
             .cameraFromModel = *machine};
    picture_ = orThrow(painter_.cameraSnapshot());
    sigma_ = sigma;
  }

  const scene::Scene& scene_;
  MachinePlace place_;
  hal::SteppedClock clock_;
  hal::SteadyClock realTime_;  // for the progress line
  std::unique_ptr<hal::Camera> camera_;
  hal::StreamFormat stream_;
  Painter painter_;
  std::optional<inspection::TemplatePose> pose_;
  hal::Image picture_;
  double sigma_ = 0.0;
};

/// The model of that name; without a name, the only one that is drawn.
MachinePlace machineNamed(const scene::Scene& scene, const std::optional<std::string>& name) {
  std::vector<std::string> names;
  for (const scene::SceneModel& model : scene.models) {
    if (model.isOccluder) continue;
    names.push_back(model.name);
    if (name != model.name) continue;
    return {.isKnown = true, .tagId = model.tagId, .attachFromModel = model.attachFromModel};
  }
  if (!name && names.size() == 1) return machineNamed(scene, names.front());
  throw hal::Failure({.kind = hal::ErrorKind::kInvalidArgument,
                      .subject = "--model",
                      .problem = name ? "the scene has no model " + *name : "which one is meant?",
                      .remedy = fmt::format("one of {}", fmt::join(names, ", "))});
}

void write(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  hal::PendingFile pending = orThrow(hal::PendingFile::create(file));
  orThrow(pending.write(bytes));
  orThrow(pending.publish());
}

}  // namespace

int takeTemplate(const ProcedureTemplateOptions& options) {
  const std::filesystem::path picture = options.folder / options.picture;
  const std::filesystem::path poseFile = inspection::templatePosePath(picture);
  refuseCollisions({{"--input", options.input}, {"--scene", options.scene}},
                   {{"PICTURE", picture}, {"its pose", poseFile}});
  const Interrupt interrupt;
  const scene::Scene scene = scene::loadScene(options.scene);
  BestFrame best(scene, machineNamed(scene, options.model), options.input);
  if (const int signal = best.find(); signal != 0) return kSignalExitBase + signal;
  if (!best.pose()) {
    throw hal::Failure({.kind = hal::ErrorKind::kInvalidInput,
                        .subject = options.input.string(),
                        .problem = "the machine's tags are in no frame",
                        .remedy = "`pleinair scene check` with --input says more"});
  }
  write(picture, orThrow(hal::encodePng(best.picture().view())));
  const std::string text = inspection::templatePoseText(*best.pose());
  write(poseFile, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  writeText(stdout, fmt::format("{} and {}; the machine was located within {:.1f} mm\n",
                                picture.string(), poseFile.string(), best.sigmaMillimetres()));
  return 0;
}

}  // namespace pleinair::app
