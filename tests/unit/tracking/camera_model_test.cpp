#include "pipeline/tracking/camera/camera_model.h"

#include <array>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace pleinair::tracking {
namespace {

const Intrinsics kIntrinsics{.fx = 612.0, .fy = 608.0, .cx = 322.4, .cy = 237.1};

CameraModel pinhole() {
  return {kIntrinsics, {}, {640, 480}};
}

/// All eight terms, at magnitudes of a wide webcam lens.
CameraModel distorted() {
  return {kIntrinsics,
          {.k1 = -0.21,
           .k2 = 0.08,
           .p1 = 0.0013,
           .p2 = -0.0009,
           .k3 = -0.012,
           .k4 = 0.05,
           .k5 = 0.015,
           .k6 = -0.004},
          {640, 480}};
}

constexpr std::array<glm::dvec3, 5> kPoints{glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(0.3, -0.2, 0.9),
                                            glm::dvec3(-0.5, 0.4, 1.3), glm::dvec3(0.02, 0.31, 0.7),
                                            glm::dvec3(-1.4, -1.1, 3.0)};

TEST(CameraModel, ProjectsByThePinholesFormula) {
  const glm::dvec2 px = pinhole().project({0.2, -0.1, 0.5});
  EXPECT_DOUBLE_EQ(px.x, 612.0 * 0.4 + 322.4);
  EXPECT_DOUBLE_EQ(px.y, 608.0 * -0.2 + 237.1);
}

/// Compares with OpenCV's formula, written out for one point (x, y) = (0.5, 0.25).
TEST(CameraModel, DistortsAsOpenCvDocuments) {
  const CameraModel camera(
      {.fx = 1.0, .fy = 1.0, .cx = 0.0, .cy = 0.0},
      {.k1 = 0.1, .k2 = 0.2, .p1 = 0.03, .p2 = 0.04, .k3 = 0.3, .k4 = 0.4, .k5 = 0.5, .k6 = 0.6},
      {2, 2});
  const double r2 = 0.3125;
  const double radial = (1 + 0.1 * r2 + 0.2 * r2 * r2 + 0.3 * r2 * r2 * r2) /
                        (1 + 0.4 * r2 + 0.5 * r2 * r2 + 0.6 * r2 * r2 * r2);
  const glm::dvec2 px = camera.project({1.0, 0.5, 2.0});
  EXPECT_NEAR(px.x, 0.5 * radial + 2 * 0.03 * 0.125 + 0.04 * (r2 + 2 * 0.25), 1e-15);
  EXPECT_NEAR(px.y, 0.25 * radial + 0.03 * (r2 + 2 * 0.0625) + 2 * 0.04 * 0.125, 1e-15);
}

TEST(CameraModel, UnprojectsEveryPixelOfThePicture) {
  for (const CameraModel& camera : {pinhole(), distorted()}) {
    for (double y = 0.0; y <= 480.0; y += 40.0) {
      for (double x = 0.0; x <= 640.0; x += 40.0) {
        const auto ray = camera.unproject({x, y});
        ASSERT_TRUE(ray) << x << ", " << y;
        EXPECT_EQ(ray->z, 1.0);
        EXPECT_LT(glm::distance(camera.project(*ray), {x, y}), 1e-8) << x << ", " << y;
      }
    }
  }
}

TEST(CameraModel, UnprojectsNothingWhereTheDistortionFoldsOver) {
  // r (1 − r²) has its largest value, 0.385, at r = 0.577.
  const CameraModel camera({.fx = 100.0, .fy = 100.0, .cx = 100.0, .cy = 100.0}, {.k1 = -1.0},
                           {200, 200});
  EXPECT_TRUE(camera.unproject({138.0, 100.0}));
  EXPECT_FALSE(camera.unproject({139.0, 100.0}));
  EXPECT_FALSE(camera.unproject({190.0, 190.0}));
}

TEST(CameraModel, JacobianAgreesWithFiniteDifferences) {
  constexpr double kStep = 1e-6;
  for (const CameraModel& camera : {pinhole(), distorted()}) {
    for (const glm::dvec3& point : kPoints) {
      const Projection shown = camera.projectWithJacobian(point);
      EXPECT_LT(glm::distance(shown.px, camera.project(point)), 1e-10);
      for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 step(0.0);
        step[axis] = kStep;
        const glm::dvec2 difference =
            (camera.project(point + step) - camera.project(point - step)) / (2.0 * kStep);
        EXPECT_LT(glm::distance(shown.pxByCameraPoint[axis], difference), 1e-4)
            << "axis " << axis << " at " << point.x << ", " << point.y << ", " << point.z;
      }
    }
  }
}

TEST(CameraModel, ResamplesAsItsPicture) {
  const glm::dvec2 scale(0.5, 0.25);
  const glm::dvec2 offset(-20.0, -7.0);
  const CameraModel camera = distorted();
  const CameraModel small = camera.resampled(scale, offset, {300, 113});
  EXPECT_EQ(small.imageSize(), (hal::FrameSize{300, 113}));
  for (const glm::dvec3& point : kPoints) {
    EXPECT_LT(glm::distance(small.project(point), scale * camera.project(point) + offset), 1e-9);
  }
}

}  // namespace
}  // namespace pleinair::tracking
