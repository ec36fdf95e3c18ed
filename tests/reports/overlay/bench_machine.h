#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "firmware_app/overlay/procedure_film.h"
#include "hal/cameras/synthetic/synthetic_camera.h"
#include "hal/error.h"
#include "pipeline/engine/painter.h"
#include "pipeline/overlay/part_shape.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/render/scene_bodies.h"

namespace pleinair {

inline const std::filesystem::path kGearboxProcedure =
    std::filesystem::path(PLEINAIR_TESTS_DIR).parent_path() / "config/procedures/gearbox";

/// The workbench with a gearbox on one of its tags, filmed by the synthetic camera, whose truth is
/// known. `tags`: those that the scene knows.
struct BenchMachine {
  static constexpr int kMachineTag = 0;
  static constexpr double kScale = 1.8;  ///< the camera stands far off

  BenchMachine(hal::SyntheticOptions options, std::vector<int> tags)
      : camera(options, clock), size(options.size) {
    hal::orThrow(camera.start({}));
    const hal::GroundTruth truth = camera.truth(0);
    scene.camera = tracking::CameraModel({.fx = truth.intrinsics.fx,
                                          .fy = truth.intrinsics.fy,
                                          .cx = truth.intrinsics.cx,
                                          .cy = truth.intrinsics.cy},
                                         {}, size);
    for (const hal::TagTruth& each : truth.tags) {
      if (std::ranges::find(tags, each.tag.id) == tags.end()) continue;
      scene.tags.push_back({.id = each.tag.id,
                            .edgeMetres = each.tag.edgeMetres,
                            .worldFromTag = each.tag.worldFromTag});
    }
    const scene::ModelSource source = scene::GearboxSource{};
    scene.models.push_back(
        {.name = "gearbox",
         .source = source,
         .model = std::make_shared<const scene::Model>(scene::modelOf(source).value()),
         .tagId = kMachineTag,
         .attachFromModel = glm::scale(glm::dmat4(1.0), glm::dvec3(kScale))});
  }

  /// The next frame, which may be changed.
  std::pair<hal::CapturedFrame, std::shared_ptr<hal::Image>> next() {
    hal::NextFrame frame = camera.next(hal::kNoDeadline);
    hal::CapturedFrame& captured = std::get<hal::CapturedFrame>(frame);
    auto image = std::make_shared<hal::Image>(captured.image);
    hal::CapturedFrame changed = captured;
    changed.image = image->view();
    changed.lease = image;
    return {std::move(changed), std::move(image)};
  }

  glm::dmat4 trueCameraFromModel(std::uint64_t sequence) const {
    const hal::GroundTruth truth = camera.truth(sequence);
    for (const hal::TagTruth& each : truth.tags) {
      if (each.tag.id == kMachineTag) {
        return truth.cameraFromWorld * each.tag.worldFromTag * scene::kTagFromAttach *
               scene.models[0].attachFromModel;
      }
    }
    throw std::logic_error("the bench has no such tag");
  }

  /// Where tracking places the machine; nothing: nowhere.
  std::optional<glm::dmat4> drawnCameraFromModel(const tracking::TrackingResult& tracked) const {
    std::vector<scene::TagSighting> seen;
    for (const tracking::TrackedTag& tag : tracked.tags) {
      if (tag.cameraFromTag) seen.push_back({tag.id, *tag.cameraFromTag, tag.covariance});
    }
    const auto attachment = scene::attachmentOf(
        scene, kMachineTag, {.cameraFromWorld = tracked.cameraFromWorld, .tags = seen});
    if (!attachment) return std::nullopt;
    return attachment->cameraFromAttach * scene.models[0].attachFromModel;
  }

  hal::SteppedClock clock;
  hal::SyntheticCamera camera;
  hal::FrameSize size;
  scene::Scene scene;
};

}  // namespace pleinair
