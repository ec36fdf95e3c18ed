// Compares motion, barycentrics and parts of each pixel with finite differences of projected points
// and plain arithmetic on the CPU.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/packing.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/models/surface_form.h"
#include "pipeline/scene/render/drawn_model.h"
#include "tests/gpu/scene/moving_models.h"
#include "tests/gpu/scene/scene_gl_test.h"
#include "tests/gpu/scene/two_poses.h"
#include "tests/oracles/surface_oracle.h"
#include "tests/support/allocation_count.h"

namespace pleinair::scene {
namespace {

using std::chrono::milliseconds;

constexpr hal::FrameSize kSize = kTwoPosesSize;
constexpr std::uint32_t kNumbers = kMaxTriangles - 1;  // the lower bits of ids and parts

struct Case {
  std::string name;
  Model (*make)();
  tracking::Distortion lens;
};

/// The buffers of two frames, and the model's pose in each.
struct Frames {
  std::vector<std::uint32_t> ids;
  std::vector<std::uint32_t> barycentrics;
  std::vector<std::uint32_t> parts;
  std::vector<std::uint32_t> forms;
  std::vector<float> motion;  // four numbers per pixel
  glm::ivec4 bounds{0};
  oracles::PosedModel previous;
  oracles::PosedModel current;
};

class SurfaceBuffers : public SceneGlTest, public testing::WithParamInterface<Case> {
 protected:
  static tracking::CameraModel camera() {
    return {{.fx = 260.0, .fy = 262.0, .cx = 122.3, .cy = 88.4}, GetParam().lens, kSize};
  }

  static Scene sceneOf(Model model) {
    Scene scene;
    SceneModel placed;
    placed.playback.clip = model.rig.clips.empty() ? std::nullopt : std::optional<std::size_t>(0);
    placed.model = std::make_shared<const Model>(std::move(model));
    scene.models.push_back(std::move(placed));
    return scene;
  }

  static oracles::PosedModel posed(const Scene& scene, hal::Duration elapsed,
                                   const glm::dmat4& cameraFromWorld) {
    const SceneModel& model = scene.models[0];
    oracles::PosedModel posed{.model = model.model.get(), .cameraFromModel = cameraFromWorld};
    poseModel(*model.model, momentOf(model.model->rig, model.playback, elapsed), elapsed,
              posed.pose);
    return posed;
  }

  Frames twoFrames(const Scene& scene) {
    ArFrameRenderer renderer(library_, scene);
    const gpu::Texture picture = plainPicture(kSize);
    const auto compose = [&](const glm::dmat4& pose, std::uint64_t sequence, hal::TimePoint time) {
      return renderer.compose(picture, camera(), {.cameraFromWorld = pose}, sequence, time,
                              {.surfaces = true});
    };
    compose(glm::dmat4(1.0), 1, hal::TimePoint{});  // time starts here
    compose(previousAslant(), 2, kPrevious);
    const ArFrame frame = compose(currentAslant(), 3, kCurrent);
    EXPECT_TRUE(frame.motion.has_value());
    EXPECT_EQ(frame.motion->sinceSequence, 2u);
    EXPECT_EQ(frame.motion->sinceTime, kPrevious);
    return {.ids = support::readR32ui(*frame.ids),
            .barycentrics = support::readR32ui(*frame.barycentrics),
            .parts = support::readR32ui(*frame.parts),
            .forms = support::readR32ui(*frame.forms),
            .motion = support::readRgba32f(*frame.motion->texture),
            .bounds = glm::ivec4(frame.objectBoundsOrAll()),
            .previous = posed(scene, kPrevious.time_since_epoch(), previousAslant()),
            .current = posed(scene, kCurrent.time_since_epoch(), currentAslant())};
  }

  /// The number of pixels that are off by more than the tolerance.
  static int wrongMotions(const Frames& frames, const oracles::PosedModel& previous, int& judged,
                          double& largestError) {
    int wrong = 0;
    for (std::size_t i = 0; i < frames.ids.size(); ++i) {
      if (frames.ids[i] == 0) continue;
      const glm::dvec2 px = pixelCentre(i);
      const auto point =
          oracles::pointBehind(frames.current, frames.ids[i] & kNumbers, camera(), px);
      if (!point) continue;
      const glm::dvec2 expected = camera().project(oracles::cameraPoint(frames.current, *point)) -
                                  camera().project(oracles::cameraPoint(previous, *point));
      const glm::dvec2 found(frames.motion[4 * i], frames.motion[4 * i + 1]);
      const double error = glm::distance(found, expected);
      const double allowed = std::max(0.01, 0.001 * glm::length(expected));
      ++judged;
      largestError = std::max(largestError, error);
      if (error > allowed) ++wrong;
    }
    return wrong;
  }

  static glm::dvec2 pixelCentre(std::size_t i) {
    return {0.5 + static_cast<double>(i % kSize.width), 0.5 + static_cast<double>(i / kSize.width)};
  }
};

TEST_P(SurfaceBuffers, MotionIsTheDifferenceOfProjectedPoints) {
  const Scene scene = sceneOf(GetParam().make());
  const Frames frames = twoFrames(scene);
  int judged = 0;
  double largest = 0.0;
  const int wrong = wrongMotions(frames, frames.previous, judged, largest);
  RecordProperty("largest_error_px", std::to_string(largest));
  EXPECT_GT(judged, 3000);
  EXPECT_LE(wrong, judged / 1000) << "largest " << largest;  // pixels exactly on a triangle's edge
  const auto first = std::ranges::find_if(frames.ids, [](std::uint32_t id) { return id != 0; });
  const auto at = static_cast<std::size_t>(4 * (first - frames.ids.begin()));
  EXPECT_EQ(frames.motion[at + 3], 1.0F);  // SurfaceMotionSource::kSurface
  EXPECT_EQ(frames.motion[at + 2], 0.0F);  // exact
}

TEST_P(SurfaceBuffers, ObjectsAreWithinTheirBounds) {
  const Frames frames = twoFrames(sceneOf(GetParam().make()));
  glm::ivec2 low(kSize.width, kSize.height);
  glm::ivec2 high(0);
  for (std::size_t i = 0; i < frames.ids.size(); ++i) {
    if (frames.ids[i] == 0 && frames.forms[i] == 0) continue;
    const glm::ivec2 pixel(pixelCentre(i));
    low = glm::min(low, pixel);
    high = glm::max(high, pixel + 1);
  }
  ASSERT_TRUE(low.x < high.x && low.y < high.y);
  EXPECT_TRUE(frames.bounds.x <= low.x && frames.bounds.y <= low.y);
  EXPECT_TRUE(frames.bounds.z >= high.x && frames.bounds.w >= high.y);
  // Else they are of no use: a ball around the model is seldom twice as wide.
  const glm::ivec2 margin = (high - low) / 2 + 8;
  EXPECT_TRUE(frames.bounds.x >= std::max(0, low.x - margin.x));
  EXPECT_TRUE(frames.bounds.z <= std::min(kSize.width, high.x + margin.x));
}

/// Negative control: motion without the model's animation, or without the camera's motion, must
/// fail.
TEST_P(SurfaceBuffers, MotionThatForgetsSomethingIsWrong) {
  const Scene scene = sceneOf(GetParam().make());
  const Frames frames = twoFrames(scene);
  int judged = 0;
  double largest = 0.0;
  oracles::PosedModel cameraStands = frames.previous;
  cameraStands.cameraFromModel = frames.current.cameraFromModel;
  EXPECT_GT(wrongMotions(frames, cameraStands, judged, largest), judged * 9 / 10);
  const bool movesByItself =
      scene.models[0].playback.clip || scene.models[0].model->parts[0].radiansPerSecond != 0.0;
  if (!movesByItself) return;
  judged = 0;
  oracles::PosedModel modelStands = frames.previous;
  modelStands.pose = frames.current.pose;
  EXPECT_GT(wrongMotions(frames, modelStands, judged, largest), judged / 3);
}

TEST_P(SurfaceBuffers, BarycentricsAndPartsAreThoseOfTheSurface) {
  const Scene scene = sceneOf(GetParam().make());
  const Frames frames = twoFrames(scene);
  const Model& model = *scene.models[0].model;
  const DrawnModel drawn(model);
  const double size = boundingSphere(model).radiusMetres;
  int wrong = 0;
  int judged = 0;
  for (std::size_t i = 0; i < frames.ids.size(); ++i) {
    const std::uint32_t number = frames.ids[i] & kNumbers;
    if (frames.ids[i] == 0) {
      ASSERT_EQ(frames.parts[i], 0u);
      ASSERT_EQ(frames.barycentrics[i], 0u);
      continue;
    }
    ASSERT_EQ(frames.parts[i] >> kTriangleBits, 1u);
    const auto* part = partOfTriangle(model, number);
    ASSERT_EQ(frames.parts[i] & kNumbers, static_cast<std::size_t>(part - model.parts.data()));
    const auto expected = oracles::pointBehind(frames.current, number, camera(), pixelCentre(i));
    if (!expected) continue;
    const glm::dvec2 two(glm::unpackUnorm2x16(frames.barycentrics[i]));
    const glm::dvec3 at(two, 1.0 - two.x - two.y);
    glm::dvec3 found(0.0);
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t corner = drawn.triangles[number].corners[static_cast<std::size_t>(c)];
      found += at[c] * glm::dvec3(drawn.rest[corner].position);
    }
    ++judged;
    if (glm::distance(found, oracles::restPoint(model, *expected)) > 2e-4 * size) ++wrong;
  }
  EXPECT_GT(judged, 3000);
  EXPECT_LE(wrong, judged / 1000);
}

/// The direction at rest is carried along by the posed triangle, and seen through the camera.
TEST_P(SurfaceBuffers, FormsAreThoseOfThePosedSurface) {
  const Scene scene = sceneOf(GetParam().make());
  const Frames frames = twoFrames(scene);
  const Model& model = *scene.models[0].model;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<TriangleForm>> forms;
  std::map<std::uint32_t, std::tuple<std::size_t, std::size_t, std::uint32_t>> patches;
  std::vector<double> errors;
  for (std::size_t i = 0; i < frames.ids.size(); ++i) {
    if (frames.ids[i] == 0) {
      ASSERT_EQ(frames.forms[i], 0U);
      continue;
    }
    const auto point =
        oracles::pointBehind(frames.current, frames.ids[i] & kNumbers, camera(), pixelCentre(i));
    if (!point) continue;
    const ModelPart& part = model.parts[point->part];
    const Mesh& mesh = model.surfaces[part.firstSurface + point->surface].mesh;
    std::vector<TriangleForm>& known = forms[{point->part, point->surface}];
    if (known.empty()) {
      std::vector<std::size_t> limbs;
      if (part.skin) limbs = limbsOf(model.rig, model.rig.skins[*part.skin]);
      known = formsOf(mesh, limbs);
    }
    const TriangleForm& form = known[point->triangle];
    const std::tuple patch(point->part, point->surface, form.patch);
    const std::uint32_t label = frames.forms[i] & 4095U;
    EXPECT_NE(label, 0U);
    EXPECT_EQ(patches.try_emplace(label, patch).first->second, patch);

    const double clarity = static_cast<double>(frames.forms[i] >> 24U & 31U) / 31.0;
    if (clarity < 0.1) continue;
    const auto& corners = mesh.triangles[point->triangle];
    const glm::dvec3 last(mesh.vertices[corners[2]].position);
    const glm::dvec3 a = glm::dvec3(mesh.vertices[corners[0]].position) - last;
    const glm::dvec3 b = glm::dvec3(mesh.vertices[corners[1]].position) - last;
    const bool isDeclared = model.strokeDirection.source == StrokeDirection::Source::kAxis;
    EXPECT_EQ(frames.forms[i] >> 31U != 0U, isDeclared);
    // These models' meshes are at rest in the model's own axes.
    const glm::dvec3 normal = glm::normalize(glm::cross(a, b));
    const glm::dvec3 axis(model.strokeDirection.axis);
    const glm::dvec3 along =
        isDeclared ? axis - glm::dot(axis, normal) * normal : glm::dvec3(form.along);
    const double det = glm::dot(a, a) * glm::dot(b, b) - glm::dot(a, b) * glm::dot(a, b);
    const double u =
        (glm::dot(along, a) * glm::dot(b, b) - glm::dot(along, b) * glm::dot(a, b)) / det;
    const double v =
        (glm::dot(along, b) * glm::dot(a, a) - glm::dot(along, a) * glm::dot(a, b)) / det;
    const double small = 1e-4 / std::max({std::abs(u), std::abs(v), 1e-6});
    oracles::TrianglePoint ahead = *point;
    ahead.barycentrics += small * glm::dvec3(u, v, -u - v);
    const glm::dvec2 seen = camera().project(oracles::cameraPoint(frames.current, ahead)) -
                            camera().project(oracles::cameraPoint(frames.current, *point));
    const double found =
        static_cast<double>(frames.forms[i] >> 12U & 4095U) * std::numbers::pi / 4096.0;
    const double apart = std::remainder(found - std::atan2(seen.y, seen.x), std::numbers::pi);
    errors.push_back(std::abs(apart) * 180.0 / std::numbers::pi);
  }
  EXPECT_GE(patches.size(), 1U);
  if (errors.empty()) return;  // a box and a ball have no directions
  std::ranges::sort(errors);
  RecordProperty("pixels", static_cast<int>(errors.size()));
  // The lens turns directions by less than this, and is not asked.
  EXPECT_LT(errors[errors.size() * 99 / 100], GetParam().lens.k1 == 0.0 ? 0.3 : 4.0);
}

Model declaring(Model model) {
  model.strokeDirection = {.source = StrokeDirection::Source::kAxis,
                           .axis = glm::normalize(glm::vec3(1.0F, 1.0F, 0.5F))};
  return model;
}
Model declaringArm() {
  return declaring(bendingArm());
}
Model declaringBall() {
  return declaring(breathingBall());
}

INSTANTIATE_TEST_SUITE_P(
    Models, SurfaceBuffers,
    testing::Values(Case{"Static", staticBox, {}}, Case{"StaticThroughALens", staticBox, kBarrel},
                    Case{"Turning", turningGears, {}}, Case{"Rigid", swingingBoxes, {}},
                    Case{"Skinned", bendingArm, {}},
                    Case{"SkinnedThroughALens", bendingArm, kBarrel},
                    Case{"Morphed", breathingBall, {}}, Case{"SkinnedDeclared", declaringArm, {}},
                    Case{"MorphedDeclared", declaringBall, {}}),
    [](const auto& instance) { return instance.param.name; });

class SteadyState : public SceneGlTest {};

/// Rotating, swinging, bending and morphing models, a plane and an occluder, with all optional
/// buffers.
TEST_F(SteadyState, AllocatesNothing) {
  Scene scene;
  const glm::dmat4 step = glm::translate(glm::dmat4(1.0), {0.03, 0.02, 0.0});
  for (Model (*make)() : {turningGears, swingingBoxes, bendingArm, breathingBall, staticBox}) {
    SceneModel placed;
    placed.model = std::make_shared<const Model>(make());
    if (!placed.model->rig.clips.empty()) placed.playback.clip = 0;
    if (!scene.models.empty()) {
      placed.attachFromModel = scene.models.back().attachFromModel * step;
    }
    scene.models.push_back(std::move(placed));
  }
  scene.models.back().isOccluder = true;
  scene.planes.push_back({.name = "desk", .sizeMetres = {0.5, 0.5}});
  ArFrameRenderer renderer(library_, scene);
  renderer.warmUp(kSize);
  const gpu::Texture picture = plainPicture(kSize);
  const tracking::CameraModel camera({.fx = 260.0, .fy = 262.0, .cx = 122.3, .cy = 88.4}, kBarrel,
                                     kSize);
  std::uint64_t sequence = 0;
  const auto play = [&](int frames) {
    for (int i = 0; i < frames; ++i) {
      ++sequence;
      const double turn = 0.01 * static_cast<double>(sequence);
      renderer.compose(picture, camera,
                       {.cameraFromWorld = glm::rotate(previousAslant(), turn, {0.0, 0.0, 1.0})},
                       sequence, hal::TimePoint(sequence * milliseconds(33)), {.surfaces = true});
    }
  };
  play(5);
  EXPECT_EQ(support::allocationsIn([&] { play(40); }), 0) << support::allocationSites();
}

}  // namespace
}  // namespace pleinair::scene
