// Motion, barycentrics and parts of each pixel, against finite differences of projected points and
// plain arithmetic on the CPU.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/packing.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/builtin_box.h"
#include "pipeline/scene/drawn_model.h"
#include "tests/gpu/scene/moving_models.h"
#include "tests/gpu/scene/scene_gl_test.h"
#include "tests/oracles/surface_oracle.h"
#include "tests/support/allocation_count.h"

namespace pleinair::scene {
namespace {

using std::chrono::milliseconds;

constexpr hal::FrameSize kSize{240, 180};
constexpr std::uint32_t kNumbers = kMaxTriangles - 1;  // the lower bits of ids and parts

const hal::TimePoint kThen{milliseconds(400)};
const hal::TimePoint kNow{milliseconds(433)};

glm::dmat4 thenAslant() {
  return glm::rotate(glm::translate(glm::dmat4(1.0), {0.012, -0.004, 0.42}), 0.72, {0.9, 0.3, 0.1});
}
/// A hand's movement further: some 5 px, and 0.6° of turn.
glm::dmat4 nowAslant() {
  return glm::rotate(glm::translate(glm::dmat4(1.0), {0.004, 0.001, 0.415}), 0.73,
                     {0.9, 0.31, 0.1});
}

struct Case {
  std::string name;
  Model (*make)();
  tracking::Distortion lens;
};

/// What two frames know, and where the model was in each.
struct Frames {
  std::vector<std::uint32_t> ids;
  std::vector<std::uint32_t> barycentrics;
  std::vector<std::uint32_t> parts;
  std::vector<float> motion;  // four numbers a pixel
  oracles::PosedModel then;
  oracles::PosedModel now;
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
      return renderer.compose(picture, camera(), {.cameraFromWorld = pose}, sequence, time, timer_,
                              {.surfaces = true});
    };
    compose(glm::dmat4(1.0), 1, hal::TimePoint{});  // time starts
    compose(thenAslant(), 2, kThen);
    const ArFrame frame = compose(nowAslant(), 3, kNow);
    EXPECT_TRUE(frame.motion.has_value());
    EXPECT_EQ(frame.motion->sinceSequence, 2u);
    EXPECT_EQ(frame.motion->sinceTime, kThen);
    return {.ids = support::readR32ui(*frame.ids),
            .barycentrics = support::readR32ui(*frame.barycentrics),
            .parts = support::readR32ui(*frame.parts),
            .motion = support::readRgba32f(*frame.motion->texture),
            .then = posed(scene, kThen.time_since_epoch(), thenAslant()),
            .now = posed(scene, kNow.time_since_epoch(), nowAslant())};
  }

  /// How many pixels are further off than the measure allows.
  static int wrongMotions(const Frames& frames, const oracles::PosedModel& then, int& judged,
                          double& largestError) {
    int wrong = 0;
    for (std::size_t i = 0; i < frames.ids.size(); ++i) {
      if (frames.ids[i] == 0) continue;
      const glm::dvec2 px = pixelCentre(i);
      const auto point = oracles::pointBehind(frames.now, frames.ids[i] & kNumbers, camera(), px);
      if (!point) continue;
      const glm::dvec2 expected = camera().project(oracles::cameraPoint(frames.now, *point)) -
                                  camera().project(oracles::cameraPoint(then, *point));
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
  const int wrong = wrongMotions(frames, frames.then, judged, largest);
  RecordProperty("largest_error_px", std::to_string(largest));
  EXPECT_GT(judged, 3000);
  EXPECT_LE(wrong, judged / 1000) << "largest " << largest;  // pixels on a triangle's very edge
  const auto first = std::ranges::find_if(frames.ids, [](std::uint32_t id) { return id != 0; });
  const auto at = static_cast<std::size_t>(4 * (first - frames.ids.begin()));
  EXPECT_EQ(frames.motion[at + 3], 1.0F);  // MotionSource::kSurface
  EXPECT_EQ(frames.motion[at + 2], 0.0F);  // exact
}

/// The measure must tell motion that forgets what moves by itself, or the camera.
TEST_P(SurfaceBuffers, MotionThatForgetsSomethingIsWrong) {
  const Scene scene = sceneOf(GetParam().make());
  const Frames frames = twoFrames(scene);
  int judged = 0;
  double largest = 0.0;
  oracles::PosedModel cameraStands = frames.then;
  cameraStands.cameraFromModel = frames.now.cameraFromModel;
  EXPECT_GT(wrongMotions(frames, cameraStands, judged, largest), judged * 9 / 10);
  const bool movesByItself =
      scene.models[0].playback.clip || scene.models[0].model->parts[0].radiansPerSecond != 0.0;
  if (!movesByItself) return;
  judged = 0;
  oracles::PosedModel modelStands = frames.then;
  modelStands.pose = frames.now.pose;
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
    const auto expected = oracles::pointBehind(frames.now, number, camera(), pixelCentre(i));
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

Model staticBox() {
  return singlePartModel("box", boxMesh({0.16, 0.12, 0.08}));
}

constexpr tracking::Distortion kBarrel{.k1 = -0.25, .k2 = 0.05, .p1 = 0.003, .p2 = -0.002};

INSTANTIATE_TEST_SUITE_P(Models, SurfaceBuffers,
                         testing::Values(Case{"Static", staticBox, {}},
                                         Case{"StaticThroughALens", staticBox, kBarrel},
                                         Case{"Turning", turningGears, {}},
                                         Case{"Rigid", swingingBoxes, {}},
                                         Case{"Skinned", bendingArm, {}},
                                         Case{"SkinnedThroughALens", bendingArm, kBarrel},
                                         Case{"Morphed", breathingBall, {}}),
                         [](const auto& instance) { return instance.param.name; });

class PlaneMotion : public SceneGlTest {
 protected:
  static tracking::CameraModel camera() {
    return {{.fx = 260.0, .fy = 262.0, .cx = 122.3, .cy = 88.4}, kBarrel, kSize};
  }
  static Scene desk() {
    Scene scene;
    scene.planes.push_back({.name = "desk", .sizeMetres = {0.2, 0.1}});
    return scene;
  }
  std::vector<float> motionOf(const Scene& scene, const tracking::PoseCovariance& covariance) {
    ArFrameRenderer renderer(library_, scene);
    const gpu::Texture picture = plainPicture(kSize);
    const ArFrameNeeds needs{.surfaces = true};
    renderer.compose(picture, camera(),
                     {.cameraFromWorld = thenAslant(), .worldCovariance = covariance}, 2, kThen,
                     timer_, needs);
    const ArFrame& frame = renderer.compose(
        picture, camera(), {.cameraFromWorld = nowAslant(), .worldCovariance = covariance}, 3, kNow,
        timer_, needs);
    return support::readRgba32f(*frame.motion->texture);
  }
  /// The desk's point behind a pixel; nothing beyond its extent.
  static std::optional<glm::dvec3> deskPoint(glm::dvec2 px) {
    const glm::dvec3 ray = *camera().unproject(px);
    const glm::dmat4 m = nowAslant();
    const glm::dvec3 normal(m[2]);
    const glm::dvec3 at = ray * (glm::dot(glm::dvec3(m[3]), normal) / glm::dot(ray, normal));
    const glm::dvec3 onDesk(glm::inverse(m) * glm::dvec4(at, 1.0));
    if (std::abs(onDesk.x) > 0.1 || std::abs(onDesk.y) > 0.05) return std::nullopt;
    return onDesk;
  }
};

TEST_F(PlaneMotion, IsThatOfThePose) {
  const auto motion = motionOf(desk(), {});
  int inside = 0;
  for (std::size_t i = 0; i < motion.size() / 4; ++i) {
    const glm::dvec2 px(0.5 + static_cast<double>(i % kSize.width),
                        0.5 + static_cast<double>(i / kSize.width));
    const auto at = deskPoint(px);
    if (!at) continue;
    ++inside;
    const glm::dvec2 then = camera().project(glm::dvec3(thenAslant() * glm::dvec4(*at, 1.0)));
    EXPECT_LT(glm::distance(glm::dvec2(motion[4 * i], motion[4 * i + 1]), px - then),
              std::max(0.01, 0.001 * glm::distance(px, then)));
    EXPECT_EQ(motion[4 * i + 3], 2.0F);  // MotionSource::kPlane
  }
  EXPECT_GT(inside, 2000);
  int known = 0;
  for (std::size_t i = 3; i < motion.size(); i += 4) known += motion[i] != 0.0F ? 1 : 0;
  EXPECT_NEAR(known, inside, 0.01 * inside);  // and no more: the extent is kept
}

/// Predicted errors against those of poses drawn from the covariance.
TEST_F(PlaneMotion, PredictsItsError) {
  std::array<double, 6> sigma{2e-3, 1e-3, 3e-3, 2e-4, 4e-4, 1e-3};
  tracking::PoseCovariance covariance{};
  for (std::size_t i = 0; i < 6; ++i) covariance[7 * i] = sigma[i] * sigma[i];
  covariance[1] = covariance[6] = 0.5 * sigma[0] * sigma[1];  // correlated
  const auto motion = motionOf(desk(), covariance);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const auto moved = [&](const glm::dmat4& pose) {
    const double a = normal(random);
    const double b = 0.5 * a + std::sqrt(0.75) * normal(random);
    const glm::dvec3 turn(sigma[0] * a, sigma[1] * b, sigma[2] * normal(random));
    const glm::dvec3 shift(sigma[3] * normal(random), sigma[4] * normal(random),
                           sigma[5] * normal(random));
    const glm::dvec3 origin(pose[3]);
    const glm::dmat4 about = glm::rotate(glm::translate(glm::dmat4(1.0), origin + shift),
                                         glm::length(turn), glm::normalize(turn)) *
                             glm::translate(glm::dmat4(1.0), -origin);
    return about * pose;
  };
  for (const glm::ivec2 pixel : {glm::ivec2(122, 88), glm::ivec2(80, 80), glm::ivec2(165, 95)}) {
    const glm::dvec2 px = glm::dvec2(pixel) + 0.5;
    double squares = 0.0;
    constexpr int kDraws = 4000;
    const glm::dvec3 truth = *deskPoint(px);
    const glm::dvec2 trueThen = camera().project(glm::dvec3(thenAslant() * glm::dvec4(truth, 1.0)));
    for (int draw = 0; draw < kDraws; ++draw) {
      // as both poses are guessed, the pixel is taken for another point, and that for elsewhere
      const glm::dmat4 now = moved(nowAslant());
      const glm::dvec3 ray = *camera().unproject(px);
      const glm::dvec3 facing(now[2]);
      const glm::dvec3 at = ray * (glm::dot(glm::dvec3(now[3]), facing) / glm::dot(ray, facing));
      const glm::dvec4 guess = glm::inverse(now) * glm::dvec4(at, 1.0);
      const glm::dvec2 then = camera().project(glm::dvec3(moved(thenAslant()) * guess));
      squares += glm::dot(then - trueThen, then - trueThen);
    }
    const double actual = std::sqrt(squares / kDraws);
    const auto i = static_cast<std::size_t>(pixel.y * kSize.width + pixel.x);
    EXPECT_NEAR(double{motion[4 * i + 2]} / actual, 1.0, 0.1) << pixel.x << ',' << pixel.y;
    EXPECT_GT(actual, 0.3);
  }
}

TEST_F(PlaneMotion, IsUnknownWithoutAPoseBefore) {
  ArFrameRenderer renderer(library_, desk());
  const gpu::Texture picture = plainPicture(kSize);
  const ArFrameNeeds needs{.surfaces = true};
  const auto next = [&](std::optional<glm::dmat4> pose, std::uint64_t sequence) {
    return renderer.compose(picture, camera(), {.cameraFromWorld = pose}, sequence, kThen, timer_,
                            needs);
  };
  EXPECT_FALSE(next(thenAslant(), 1).motion.has_value());
  const auto middleSource = [&](const ArFrame& frame) {
    return support::readRgba32f(*frame.motion->texture)[(88 * 240 + 122) * 4 + 3];
  };
  EXPECT_EQ(middleSource(next(nowAslant(), 2)), 2.0F);
  EXPECT_EQ(middleSource(next(std::nullopt, 3)), 0.0F);
  EXPECT_EQ(middleSource(next(nowAslant(), 4)), 0.0F);
  EXPECT_EQ(middleSource(next(nowAslant(), 5)), 2.0F);
  renderer.reset();
  EXPECT_FALSE(next(nowAslant(), 6).motion.has_value());
}

class SteadyState : public SceneGlTest {};

/// Models that turn, swing, bend and breathe, a plane and an occluder, with all that is asked for.
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
      renderer.compose(
          picture, camera, {.cameraFromWorld = glm::rotate(thenAslant(), turn, {0.0, 0.0, 1.0})},
          sequence, hal::TimePoint(sequence * milliseconds(33)), timer_, {.surfaces = true});
    }
  };
  play(5);
  EXPECT_EQ(support::allocationsIn([&] { play(40); }), 0) << support::allocationSites();
}

class Occluders : public SceneGlTest {};

TEST_F(Occluders, HideWhatIsBehindThemAndShowTheCamera) {
  Scene scene;
  for (const double z : {0.5, 0.4}) {  // a wide box, and a narrow one before it
    SceneModel box = placed(BoxSource{{z == 0.5 ? 0.3 : 0.1, 0.3, 0.01}});
    box.attachFromModel = glm::translate(glm::dmat4(1.0), {0.0, 0.0, z});
    box.focus = 1.0F;
    scene.models.push_back(std::move(box));
  }
  scene.models[1].isOccluder = true;
  ArFrameRenderer renderer(library_, scene);
  const gpu::Texture picture = plainPicture(kSize);
  const tracking::CameraModel camera({.fx = 200.0, .fy = 200.0, .cx = 120.0, .cy = 90.0}, {},
                                     kSize);
  const ArFrame& frame = compose(renderer, picture, camera, {.cameraFromWorld = glm::dmat4(1.0)});
  hal::Image colour = support::readRgba8(*frame.colour);
  hal::Image normals = support::readRgba8(*frame.normalFocus);
  const auto ids = support::readR32ui(*frame.ids);
  const auto depth = readDepth(*frame.depth);
  const std::size_t hidden = 90 * 240 + 120;
  const std::size_t seen = 90 * 240 + 70;
  EXPECT_EQ(ids[hidden] >> kTriangleBits, 2u | kRealObject);
  EXPECT_EQ(ids[seen] >> kTriangleBits, 1u);
  EXPECT_LT(depth[hidden], depth[seen]);
  EXPECT_TRUE(std::ranges::equal(colour.plane(0).subspan(4 * hidden, 3), kGround));
  EXPECT_FALSE(std::ranges::equal(colour.plane(0).subspan(4 * seen, 3), kGround));
  EXPECT_TRUE(
      std::ranges::equal(normals.plane(0).subspan(4 * hidden, 4), std::array{128, 128, 128, 0}));
}

/// They are where their pose says, which may be wrong; what is virtual is where it is drawn.
TEST_F(Occluders, MoveAsWellAsTheirPoseIsKnown) {
  Scene scene;
  for (const double x : {-0.1, 0.1}) {
    SceneModel box = placed(BoxSource{{0.1, 0.1, 0.01}});
    box.attachFromModel = glm::translate(glm::dmat4(1.0), {x, 0.0, 0.0});
    scene.models.push_back(std::move(box));
  }
  scene.models[1].isOccluder = true;
  ArFrameRenderer renderer(library_, scene);
  const gpu::Texture picture = plainPicture(kSize);
  const tracking::CameraModel camera({.fx = 200.0, .fy = 200.0, .cx = 120.0, .cy = 90.0}, {},
                                     kSize);
  constexpr double kSigmaMetres = 1e-3;
  tracking::PoseCovariance covariance{};
  covariance[7 * 3] = kSigmaMetres * kSigmaMetres;  // across
  const PoseSet poses{.cameraFromWorld = glm::translate(glm::dmat4(1.0), {0.0, 0.0, 0.4}),
                      .worldCovariance = covariance};
  std::vector<float> motion;
  for (const std::uint64_t sequence : {1U, 2U}) {
    const ArFrame& frame =
        renderer.compose(picture, camera, poses, sequence, kThen, timer_, {.surfaces = true});
    if (frame.motion) motion = support::readRgba32f(*frame.motion->texture);
  }
  ASSERT_FALSE(motion.empty());
  const float* const isVirtual = &motion[4 * std::size_t{90 * 240 + 70}];
  const float* const isReal = &motion[4 * std::size_t{90 * 240 + 170}];
  EXPECT_EQ(isVirtual[3], 1.0F);  // MotionSource::kSurface
  EXPECT_EQ(isReal[3], 1.0F);
  EXPECT_EQ(isVirtual[2], 0.0F);
  // Both frames' poses err; the box's front is 0.4 m away, or 5 mm nearer.
  EXPECT_NEAR(isReal[2], std::sqrt(2.0) * kSigmaMetres * 200.0 / 0.4, 0.02);
}

}  // namespace
}  // namespace pleinair::scene
