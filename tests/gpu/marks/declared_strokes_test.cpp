// The tensor field on models whose scene declares the direction of strokes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/builtin/builtin_box.h"
#include "pipeline/scene/builtin/shapes.h"
#include "pipeline/scene/render/ar_frame_renderer.h"
#include "tests/gpu/marks/tensor_field_fixture.h"
#include "tests/gpu/scene/moving_models.h"
#include "tests/oracles/surface_oracle.h"
#include "tests/oracles/tensor_oracle.h"

namespace pleinair::marks {
namespace {

using scene::StrokeDirection;

class DeclaredStrokes : public TensorFieldFixture {
 protected:
  static tracking::CameraModel camera() {
    return {{.fx = 260.0, .fy = 260.0, .cx = 128.0, .cy = 64.0}, {}, kSize};
  }
  static glm::dmat4 place() {
    return glm::rotate(glm::translate(glm::dmat4(1.0), {0.0, 0.0, 0.4}), 0.3, {0.2, 1.0, 0.1});
  }
  static scene::Model tube() {
    const std::array<glm::dvec2, 4> section{
        {{0.04, -0.08}, {0.07, -0.08}, {0.07, 0.08}, {0.04, 0.08}}};
    scene::Model model = scene::singlePartModel("tube", scene::turned(section, true, 48));
    model.parts[0].modelFromPart =
        glm::rotate(glm::dmat4(1.0), 0.5 * std::numbers::pi, {0.0, 1.0, 0.0});
    return model;
  }

  /// The axis of the model at rest on the triangle, carried along by its corners, as a line in the
  /// image; nothing where it is seen or lies steeply.
  static std::optional<double> seenAngle(const oracles::PosedModel& posed,
                                         const oracles::TrianglePoint& point, glm::dvec3 axis) {
    const scene::Model& model = *posed.model;
    const scene::ModelPart& part = model.parts[point.part];
    const auto& corners =
        model.surfaces[part.firstSurface + point.surface].mesh.triangles[point.triangle];
    scene::ModelPose rest;
    scene::poseModel(model, std::nullopt, {}, rest);
    const auto restAt = [&](std::size_t i) {
      return glm::dvec3(
          scene::posedVertex(model, part, point.surface, corners.at(i), rest).position);
    };
    const glm::dvec3 a = restAt(0) - restAt(2);
    const glm::dvec3 b = restAt(1) - restAt(2);
    const glm::dvec3 normal = glm::normalize(glm::cross(a, b));
    const glm::dvec3 along = axis - glm::dot(axis, normal) * normal;
    if (glm::length(along) < 0.35) return std::nullopt;
    // along = u a + v b
    const double u = glm::dot(glm::cross(along, b), normal) / glm::dot(glm::cross(a, b), normal);
    const double v = glm::dot(glm::cross(a, along), normal) / glm::dot(glm::cross(a, b), normal);
    oracles::TrianglePoint ahead = point;
    const double small = 1e-4 / std::max(std::abs(u), std::abs(v));
    ahead.barycentrics += small * glm::dvec3(u, v, -u - v);
    const glm::dvec2 seen = camera().project(oracles::cameraPoint(posed, ahead)) -
                            camera().project(oracles::cameraPoint(posed, point));
    const double distance = oracles::cameraPoint(posed, point).z;
    const double step =
        glm::distance(oracles::cameraPoint(posed, ahead), oracles::cameraPoint(posed, point));
    if (glm::length(seen) * distance / camera().intrinsics().fx < 0.6 * step) {
      return std::nullopt;
    }
    return std::atan2(seen.y, seen.x);
  }

  /// The angles, in degrees, between the resolved field and `axis`, sorted: over regions that the
  /// model fills and that no silhouette is near.
  std::vector<double> errorsOf(scene::Model model, const StrokeDirection& declared, glm::dvec3 axis,
                               hal::Duration elapsed = {}) {
    model.strokeDirection = declared;
    scene::Scene scene;
    scene.light.shadow = 0.0F;
    scene::SceneModel placed;
    if (!model.rig.clips.empty()) placed.playback.clip = 0;
    placed.model = std::make_shared<const scene::Model>(std::move(model));
    scene.models.push_back(placed);
    scene::ArFrameRenderer renderer(library_, scene);
    const gpu::Texture picture =
        support::textureOf(greyPicture(kSize, [](glm::dvec2) { return 0.5; }).view());
    field_->reset();
    scene::ArFrame frame;
    for (const hal::Duration at : {hal::Duration::zero(), elapsed}) {
      frame = renderer.compose(picture, camera(), {.cameraFromWorld = place()}, ++sequence_,
                               hal::TimePoint(at),
                               {.surfaces = true, .shading = scene::Shading::kSmooth});
    }
    motion_ = standing();
    motion_.frameSize = kSize;
    frame.measuredMotion = scene::MeasuredMotion{.motion = &motion_};
    motionField_->update(frame);
    field_->update(frame, *frame.colour, *motionField_, kNoMemory);
    const std::vector<FieldTexel> found = read(field_->resolvedModels(0));
    const std::vector<std::uint32_t> ids = support::readR32ui(*frame.ids);
    hal::Image normals = support::readRgba8(*frame.normalFocus);
    oracles::PosedModel posed{.model = placed.model.get(), .cameraFromModel = place()};
    scene::poseModel(*placed.model, momentOf(placed.model->rig, placed.playback, elapsed), elapsed,
                     posed.pose);
    std::vector<double> errors;
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 32; ++x) {
        bool isInside = true;
        for (int i = -4; i < 12 && isInside; ++i) {
          for (int j = -4; j < 12 && isInside; ++j) {
            const int px = 8 * x + i;
            const int py = 8 * y + j;
            isInside = px >= 0 && py >= 0 && px < kSize.width && py < kSize.height;
            if (!isInside) continue;
            const auto at = static_cast<std::size_t>(py * kSize.width + px);
            const std::uint8_t* const normal = normals.row(0, py).data() + 4 * px;
            const double nx = normal[0] / 127.5 - 1.0;
            const double ny = normal[1] / 127.5 - 1.0;
            isInside = ids[at] != 0 && nx * nx + ny * ny < 0.6;
          }
        }
        if (!isInside) continue;
        const glm::dvec2 px(8.0 * x + 4.5, 8.0 * y + 4.5);
        const std::uint32_t id =
            ids[static_cast<std::size_t>((8 * y + 4) * kSize.width + 8 * x + 4)];
        const auto point =
            oracles::pointBehind(posed, id & (scene::kMaxTriangles - 1), camera(), px);
        if (!point) continue;
        const auto along = seenAngle(posed, *point, axis);
        if (!along) continue;
        const double across = *along + 0.5 * std::numbers::pi;
        const glm::dvec2 truth(std::cos(2.0 * across), std::sin(2.0 * across));
        errors.push_back(degrees(oracles::angleBetween(found[placeOf(x, y)].tensor, truth)));
      }
    }
    std::ranges::sort(errors);
    return errors;
  }
};

constexpr double kMostOff = 3.0;  // degrees

TEST_F(DeclaredStrokes, TheFieldFollowsAnAxisWhereCurvatureSaysOtherwise) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1.0, 1.0, 0.3));
  const StrokeDirection declared{.source = StrokeDirection::Source::kAxis, .axis = glm::vec3(axis)};
  const std::vector<double> on = errorsOf(tube(), declared, axis);
  ASSERT_GT(on.size(), 10U);
  EXPECT_LT(on.back(), kMostOff);
  const std::vector<double> off = errorsOf(tube(), {}, axis);
  EXPECT_GT(off[off.size() / 2], 15.0) << "the control: strokes along the tube";
}

TEST_F(DeclaredStrokes, AFlatBoxHasADirectionOnceDeclared) {
  const scene::Model box = scene::singlePartModel("box", scene::boxMesh({0.2, 0.12, 0.08}));
  const glm::dvec3 axis = glm::normalize(glm::dvec3(0.3, 1.0, 0.0));
  const StrokeDirection declared{.source = StrokeDirection::Source::kAxis, .axis = glm::vec3(axis)};
  const std::vector<double> on = errorsOf(box, declared, axis);
  ASSERT_GT(on.size(), 10U);
  EXPECT_LT(on[on.size() * 9 / 10], kMostOff);  // at an edge of the box, two sides meet
  const std::vector<double> off = errorsOf(box, {}, axis);
  EXPECT_GT(off[off.size() / 2], 15.0) << "the control";
}

/// A skin carries the direction along.
TEST_F(DeclaredStrokes, TheFieldFollowsAPosedModel) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1.0, 1.0, 0.3));
  const StrokeDirection declared{.source = StrokeDirection::Source::kAxis, .axis = glm::vec3(axis)};
  const hal::Duration bent = std::chrono::milliseconds(500);
  const std::vector<double> on = errorsOf(scene::bendingArm(), declared, axis, bent);
  ASSERT_GT(on.size(), 5U);
  EXPECT_LT(on[on.size() / 2], kMostOff);
  EXPECT_LT(on[on.size() * 9 / 10], 9.0) << "within a region, triangles differ";
  const std::vector<double> off = errorsOf(scene::bendingArm(), {}, axis, bent);
  EXPECT_GT(off[off.size() / 2], 15.0) << "the control";
}

}  // namespace
}  // namespace pleinair::marks
