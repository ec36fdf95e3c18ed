// Planes and occluders, which represent real objects: their motion, its predicted error, and the
// models that they hide.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/scene/scene_gl_test.h"
#include "tests/gpu/scene/two_poses.h"
#include "tests/support/random_vectors.h"

namespace pleinair::scene {
namespace {

constexpr hal::FrameSize kSize = kTwoPosesSize;

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
                     {.cameraFromWorld = previousAslant(), .worldCovariance = covariance}, 2,
                     kPrevious, needs);
    const ArFrame& frame = renderer.compose(
        picture, camera(), {.cameraFromWorld = currentAslant(), .worldCovariance = covariance}, 3,
        kCurrent, needs);
    return support::readRgba32f(*frame.motion->texture);
  }
  /// The point of the desk at a pixel; nothing beyond its extent.
  static std::optional<glm::dvec3> deskPoint(glm::dvec2 px) {
    const glm::dvec3 ray = *camera().unproject(px);
    const glm::dmat4 m = currentAslant();
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
    const glm::dvec2 previous =
        camera().project(glm::dvec3(previousAslant() * glm::dvec4(*at, 1.0)));
    EXPECT_LT(glm::distance(glm::dvec2(motion[4 * i], motion[4 * i + 1]), px - previous),
              std::max(0.01, 0.001 * glm::distance(px, previous)));
    EXPECT_EQ(motion[4 * i + 3], 2.0F);  // SurfaceMotionSource::kPlane
  }
  EXPECT_GT(inside, 2000);
  int known = 0;
  for (std::size_t i = 3; i < motion.size(); i += 4) known += motion[i] != 0.0F ? 1 : 0;
  EXPECT_NEAR(known, inside, 0.01 * inside);  // and no more: the extent is kept
}

/// Compares predicted errors with those of poses drawn from the covariance.
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
    const glm::dvec3 shift =
        glm::dvec3(sigma[3], sigma[4], sigma[5]) * support::randomVec3(normal, random);
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
    const glm::dvec2 trueThen =
        camera().project(glm::dvec3(previousAslant() * glm::dvec4(truth, 1.0)));
    for (int draw = 0; draw < kDraws; ++draw) {
      // with both poses wrong, the pixel is taken for another point, which is projected elsewhere
      const glm::dmat4 current = moved(currentAslant());
      const glm::dvec3 ray = *camera().unproject(px);
      const glm::dvec3 facing(current[2]);
      const glm::dvec3 at =
          ray * (glm::dot(glm::dvec3(current[3]), facing) / glm::dot(ray, facing));
      const glm::dvec4 guess = glm::inverse(current) * glm::dvec4(at, 1.0);
      const glm::dvec2 previous = camera().project(glm::dvec3(moved(previousAslant()) * guess));
      squares += glm::dot(previous - trueThen, previous - trueThen);
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
    return renderer.compose(picture, camera(), {.cameraFromWorld = pose}, sequence, kPrevious,
                            needs);
  };
  EXPECT_FALSE(next(previousAslant(), 1).motion.has_value());
  const auto middleSource = [&](const ArFrame& frame) {
    return support::readRgba32f(*frame.motion->texture)[(88 * 240 + 122) * 4 + 3];
  };
  EXPECT_EQ(middleSource(next(currentAslant(), 2)), 2.0F);
  EXPECT_EQ(middleSource(next(std::nullopt, 3)), 0.0F);
  EXPECT_EQ(middleSource(next(currentAslant(), 4)), 0.0F);
  EXPECT_EQ(middleSource(next(currentAslant(), 5)), 2.0F);
  renderer.reset();
  EXPECT_FALSE(next(currentAslant(), 6).motion.has_value());
}

class Occluders : public SceneGlTest {};

TEST_F(Occluders, HideWhatIsBehindThemAndShowTheCamera) {
  Scene scene;
  for (const double z : {0.5, 0.4}) {  // a wide box, and a narrow one in front of it
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

/// Occluders are at their estimated poses, which may be wrong; virtual models are where they are
/// drawn.
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
        renderer.compose(picture, camera, poses, sequence, kPrevious, {.surfaces = true});
    if (frame.motion) motion = support::readRgba32f(*frame.motion->texture);
  }
  ASSERT_FALSE(motion.empty());
  const float* const isVirtual = &motion[4 * std::size_t{90 * 240 + 70}];
  const float* const isReal = &motion[4 * std::size_t{90 * 240 + 170}];
  EXPECT_EQ(isVirtual[3], 1.0F);  // SurfaceMotionSource::kSurface
  EXPECT_EQ(isReal[3], 1.0F);
  EXPECT_EQ(isVirtual[2], 0.0F);
  // The poses of both frames are wrong; the box's front is 0.4 m away, or 5 mm nearer.
  EXPECT_NEAR(isReal[2], std::sqrt(2.0) * kSigmaMetres * 200.0 / 0.4, 0.02);
}

}  // namespace
}  // namespace pleinair::scene
