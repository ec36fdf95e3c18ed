#include "tests/reports/anchors/drift_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "hal/cameras/synthetic/synthetic_camera.h"
#include "hal/cameras/synthetic/world/workbench.h"
#include "hal/clock.h"
#include "pipeline/gpu/gpu_shaders.h"
#include "pipeline/marks/anchors/anchor_set.h"
#include "pipeline/marks/marks_shaders.h"
#include "pipeline/scene/render/ar_frame_renderer.h"
#include "pipeline/scene/scene_shaders.h"
#include "pipeline/tracking/motion/image_motion_estimator.h"
#include "pipeline/tracking/pose/tracker.h"
#include "tests/reports/tracking/pose_measures.h"
#include "tests/reports/tracking/truth_sequence.h"

namespace pleinair::marks {
namespace {

using hal::SyntheticShot;
using tracking::percentile;

constexpr hal::FrameSize kSize{640, 480};
constexpr std::size_t kFrames = 90;
constexpr double kNoise = 2.0;
constexpr std::array<int, 2> kAges{10, 30};  // ages, in frames, at which drift is measured

enum class Poses { kNone, kEstimated, kTrue };

/// The true place of an anchor, while it is known.
struct Followed {
  std::uint32_t seed = 0;
  glm::dvec2 expected{0.0};
  int age = 0;
};

/// A camera image in RGBA.
std::vector<std::uint8_t> greyOf(const hal::ImageView& luma) {
  std::vector<std::uint8_t> rgba;
  for (int y = 0; y < luma.format.size.height; ++y) {
    for (const std::uint8_t level :
         luma.row(0, y).first(static_cast<std::size_t>(luma.format.size.width))) {
      rgba.insert(rgba.end(), {level, level, level, 255});
    }
  }
  return rgba;
}

/// The errors measured on a shot.
struct Drifts {
  std::vector<double> step;                  ///< error of a frame's displacement, px
  std::array<std::vector<double>, 2> after;  ///< after the frames of kAges
  std::array<double, 7> bySource{};
  std::array<double, 7> squares{};           ///< of the displacement errors, by source
  std::array<double, 7> predictedSquares{};  ///< of the predicted errors
};

/// A thing on the bench whose size and place are known, but for its small parts.
struct Thing {
  glm::dmat4 worldFromBox{1.0};
  glm::dvec3 sizeMetres{0.0};
};

std::array<Thing, 3> things() {
  using namespace hal::synthetic;  // NOLINT(google-build-using-namespace): the layout's names
  return {Thing{kToolboxPose, kToolboxSize}, Thing{kMachinePose, kMachineSize},
          Thing{kBooksPose * glm::translate(glm::dmat4(1.0), {0.0, 0.0, 0.030}),
                {0.215, 0.152, kBooksHeight - 0.030}}};
}

/// Whether a ray from the camera, along (x, y, 1) in its frame, meets the box.
bool isHit(const Thing& thing, const glm::dmat4& cameraFromWorld, const glm::dvec3& ray) {
  const glm::dmat4 boxFromCamera = glm::inverse(cameraFromWorld * thing.worldFromBox);
  const glm::dvec3 from(boxFromCamera[3]);
  const glm::dvec3 along(boxFromCamera * glm::dvec4(ray, 0.0));
  const glm::dvec3 half(0.5 * thing.sizeMetres.x, 0.5 * thing.sizeMetres.y, 0.0);
  const glm::dvec3 low = (glm::dvec3(-half.x, -half.y, 0.0) - from) / along;
  const glm::dvec3 high = (glm::dvec3(half.x, half.y, thing.sizeMetres.z) - from) / along;
  const glm::dvec3 first = glm::min(low, high);
  const glm::dvec3 last = glm::max(low, high);
  return std::max({first.x, first.y, first.z, 0.0}) < std::min({last.x, last.y, last.z});
}

enum class Where { kEverywhere, kOnThings };

scene::Scene benchScene(Poses poses, Where where) {
  scene::Scene scene;
  if (poses == Poses::kNone) return scene;
  if (where == Where::kOnThings) {
    for (const Thing& thing : things()) {
      scene::SceneModel model;
      model.source = scene::BoxSource{thing.sizeMetres};
      model.model = std::make_shared<const scene::Model>(scene::modelOf(model.source).value());
      model.attachFromModel = thing.worldFromBox;
      model.isOccluder = true;
      scene.models.push_back(std::move(model));
    }
    return scene;
  }
  // The top of the workbench; the objects on it are not part of the plane.
  scene.planes.push_back({.name = "bench",
                          .attachFromPlane = glm::translate(glm::dmat4(1.0), {0.0, -0.01, 0.0}),
                          .sizeMetres = {2.3, 0.9}});
  return scene;
}

class DriftRun {
 public:
  DriftRun(const tracking::TruthSequence& sequence, SyntheticShot shot, Poses poses, Where where)
      : sequence_(sequence),
        poses_(poses),
        where_(where),
        truth_({.size = kSize, .shot = shot, .noiseSigma = kNoise}, clock_),
        tracker_(sequence.camera, sequence.markers) {
    library_.add(gpu::gpuShaders());
    library_.add(gpu::sceneShaders());
    library_.add(gpu::marksShaders());
    picture_ = gpu::Texture(gpu::TextureFormat::kRgba8, kSize, gpu::TextureFilter::kLinear);
    renderer_.emplace(library_, benchScene(poses, where));
    field_.emplace(library_, kSize);
    anchors_.emplace(library_, kSize, AnchorOptions{});
  }

  Drifts run() {
    for (std::size_t i = 0; i < sequence_.frames.size(); ++i) {
      advance(i);
      follow(i);
    }
    return drifts_;
  }

 private:
  scene::PoseSet posesOf(const tracking::TruthFrame& frame) {
    if (poses_ == Poses::kNone) return {};
    if (poses_ == Poses::kTrue) return {.cameraFromWorld = frame.cameraFromWorld};
    const tracking::TrackingResult tracked = tracker_.track(frame.luma.view(), frame.time);
    return {.cameraFromWorld = tracked.cameraFromWorld, .worldCovariance = tracked.worldCovariance};
  }

  void advance(std::size_t i) {
    const tracking::TruthFrame& frame = sequence_.frames[i];
    const tracking::ImageMotion& motion =
        estimator_.follow(frame.luma.view().planes[0], kSize, i + 1);
    picture_.upload(greyOf(frame.luma.view()), std::size_t{4} * kSize.width);
    scene::ArFrame composed =
        renderer_->compose(picture_, sequence_.camera, posesOf(frame), i + 1, frame.time,
                           {.surfaces = true, .measuredMotion = true});
    composed.measuredMotion = scene::MeasuredMotion{.motion = &motion};
    field_->update(composed);
    anchors_->advance(composed, *field_);
  }

  /// Follows the anchors of frame i, with px in 0 … size.
  void follow(std::size_t i) {
    const std::vector<Anchor> now = anchors_->read();
    followed_.resize(now.size());
    before_.resize(now.size());
    for (std::size_t slot = 0; slot < now.size(); ++slot) {
      const Anchor& each = now[slot];
      std::optional<Followed>& followed = followed_[slot];
      const bool isNew = !followed || followed->seed != each.seed;
      if (!each.isStaying()) {
        followed.reset();
      } else if (isNew) {
        followed.reset();
        if (each.isBorn() && isMeasured(i, glm::dvec2(each.px)))
          followed = Followed{.seed = each.seed, .expected = glm::dvec2(each.px)};
      } else {
        compare(i, each, before_[slot], followed);
      }
    }
    before_ = now;
  }

  bool isMeasured(std::size_t i, glm::dvec2 px) const {
    if (where_ == Where::kEverywhere) return true;
    const std::optional<glm::dvec3> ray = sequence_.camera.unproject(px);
    return ray && std::ranges::any_of(things(), [&](const Thing& thing) {
             return isHit(thing, sequence_.frames[i].cameraFromWorld, *ray);
           });
  }

  void compare(std::size_t i, const Anchor& now, const Anchor& then,
               std::optional<Followed>& followed) {
    const hal::FlowVector step = truth_.flow(i - 1, i, glm::dvec2(then.px));
    if (step.visible) {
      const double error = glm::distance(glm::dvec2(now.px) - glm::dvec2(then.px), step.px);
      const auto source = static_cast<std::size_t>(now.source());
      drifts_.step.push_back(error);
      drifts_.bySource.at(source) += 1.0;
      drifts_.squares.at(source) += error * error;
      drifts_.predictedSquares.at(source) += now.errorPx * now.errorPx;
    }
    const hal::FlowVector flow = truth_.flow(i - 1, i, followed->expected);
    if (!flow.visible) {
      followed.reset();
      return;
    }
    followed->expected += flow.px;
    ++followed->age;
    for (std::size_t k = 0; k < kAges.size(); ++k) {
      if (followed->age == kAges.at(k)) {
        drifts_.after.at(k).push_back(glm::distance(glm::dvec2(now.px), followed->expected));
      }
    }
  }

  const tracking::TruthSequence& sequence_;
  Poses poses_;
  Where where_;
  hal::SteppedClock clock_;
  hal::SyntheticCamera truth_;
  tracking::Tracker tracker_;
  tracking::ImageMotionEstimator estimator_;
  gpu::ShaderLibrary library_;
  gpu::Texture picture_;
  std::optional<scene::ArFrameRenderer> renderer_;
  std::optional<MotionField> field_;
  std::optional<AnchorSet> anchors_;
  std::vector<std::optional<Followed>> followed_;
  std::vector<Anchor> before_;
  Drifts drifts_;
};

std::string sourcesText(const Drifts& drifts) {
  static constexpr std::array<const char*, 7> kNames{"unknown",  "surface", "plane", "picture",
                                                     "features", "flow",    "still"};
  double sum = 0.0;
  for (const double each : drifts.bySource) sum += each;
  std::string text;
  for (std::size_t k = 0; k < kNames.size(); ++k) {
    const double percent = 100.0 * drifts.bySource.at(k) / sum;
    if (percent < 0.5) continue;
    text +=
        fmt::format("{}{} {:.0f} % ({:.2f}, said {:.2f})", text.empty() ? "" : ", ", kNames.at(k),
                    percent, std::sqrt(drifts.squares.at(k) / drifts.bySource.at(k)),
                    std::sqrt(drifts.predictedSquares.at(k) / drifts.bySource.at(k)));
  }
  return text;
}

}  // namespace

void reportDrifts(const std::set<std::string>& parts) {
  const auto wants = [&](SyntheticShot shot) {
    return parts.contains("drifts") || parts.empty() || parts.contains(std::string(toString(shot)));
  };
  std::printf(
      "\n### Anchor drift on the workbench, px, median / 95th percentile\n\n"
      "| shot | told by | a frame | after 10 | after 30 | moved by (RMS error a frame, as "
      "predicted) |\n|---|---|---|---|---|---|\n");
  for (const SyntheticShot shot :
       {SyntheticShot::kStill, SyntheticShot::kPan, SyntheticShot::kWalkaround,
        SyntheticShot::kDolly, SyntheticShot::kRoll, SyntheticShot::kOccluder}) {
    if (!wants(shot)) continue;
    const tracking::TruthSequence sequence = tracking::filmWorkbench(
        {.shot = shot, .frameCount = kFrames, .size = kSize, .noiseSigma = kNoise});
    for (const auto& [poses, where, name] :
         {std::tuple{Poses::kNone, Where::kEverywhere, "picture"},
          std::tuple{Poses::kEstimated, Where::kEverywhere, "and estimated poses"},
          std::tuple{Poses::kTrue, Where::kEverywhere, "and true poses"},
          std::tuple{Poses::kNone, Where::kOnThings, "on three things: picture"},
          std::tuple{Poses::kEstimated, Where::kOnThings, "and models, estimated poses"},
          std::tuple{Poses::kTrue, Where::kOnThings, "and models, true poses"}}) {
      const Drifts drifts = DriftRun(sequence, shot, poses, where).run();
      std::printf("| %s | %s | %.3f / %.3f | %.3f / %.3f | %.3f / %.3f | %s |\n",
                  std::string(toString(shot)).c_str(), name, percentile(drifts.step, 0.5),
                  percentile(drifts.step, 0.95), percentile(drifts.after[0], 0.5),
                  percentile(drifts.after[0], 0.95), percentile(drifts.after[1], 0.5),
                  percentile(drifts.after[1], 0.95), sourcesText(drifts).c_str());
    }
  }
}

}  // namespace pleinair::marks
