// The tensors of planes and real things (thesis §6.2): their past goes with the surface, where the
// image's motion is unknown.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/builtin/builtin_box.h"
#include "pipeline/scene/render/ar_frame_renderer.h"
#include "tests/gpu/marks/tensor_field_fixture.h"
#include "tests/oracles/tensor_oracle.h"

namespace pleinair::marks {
namespace {

/// A textured plate before a plain wall. The camera stands and sees no features.
class TensorPlanes : public TensorFieldFixture {
 protected:
  static constexpr double kWidth = 0.28;
  static constexpr double kHeight = 0.16;
  static constexpr double kThick = 0.02;
  enum class Knows { kPlane, kRealThing, kNothing };

  static tracking::CameraModel camera() {
    return {{.fx = 260.0, .fy = 260.0, .cx = 128.0, .cy = 64.0}, {}, kSize};
  }
  static glm::dmat4 rolled(double angle) {
    return glm::rotate(glm::translate(glm::dmat4(1.0), {0.0, 0.0, 0.5}), angle, {0.0, 0.0, 1.0});
  }
  static glm::dmat4 tilted(double angle) {
    return glm::rotate(
        glm::rotate(glm::translate(glm::dmat4(1.0), {0.0, 0.0, 0.5}), angle, {0.0, 1.0, 0.2}),
        3.1415926535 / 4.0, {0.0, 0.0, 1.0});
  }

  /// The place on the plate, metres; nothing beside it.
  static std::optional<glm::dvec2> onPlate(glm::dvec2 px, const glm::dmat4& cameraFromPlate) {
    const glm::dvec3 ray((px.x - 128.0) / 260.0, (px.y - 64.0) / 260.0, 1.0);
    const glm::dmat4 back = glm::inverse(cameraFromPlate);
    const glm::dvec3 eye(back * glm::dvec4(0.0, 0.0, 0.0, 1.0));
    const glm::dvec3 along(back * glm::dvec4(ray, 0.0));
    const glm::dvec3 hit = eye - eye.z / along.z * along;
    if (std::abs(hit.x) > 0.5 * kWidth || std::abs(hit.y) > 0.5 * kHeight) return std::nullopt;
    return glm::dvec2(hit);
  }
  static double lumaOnPlate(glm::dvec2 at) {
    return 0.5 + 0.3 * std::sin(260.0 * glm::distance(at, glm::dvec2(-0.2, -0.1)));
  }

  void useScene(Knows knows) {
    scene_ = {};
    scene_.light.shadow = 0.0F;
    if (knows == Knows::kPlane) {
      scene_.planes.push_back({.name = "plate", .sizeMetres = {kWidth, kHeight}});
    } else if (knows == Knows::kRealThing) {
      scene::SceneModel box;
      box.model = std::make_shared<const scene::Model>(
          scene::singlePartModel("plate", scene::boxMesh({kWidth, kHeight, kThick})));
      box.isOccluder = true;
      scene_.models.push_back(box);  // stands behind z = 0, away from the camera
    }
    renderer_.emplace(library_, scene_);
    field_->reset();
    motionField_->reset();
    sequence_ = 0;
    time_ = {};
  }

  void see(const glm::dmat4& cameraFromPlate) {
    const hal::Image image = greyPicture(kSize, [&](glm::dvec2 px) {
      const auto at = onPlate(px, cameraFromPlate);
      return at ? lumaOnPlate(*at) : 0.5;
    });
    picture_ = support::textureOf(image.view());
    time_ += kStep;
    scene::ArFrame frame =
        renderer_->compose(picture_, camera(), {.cameraFromWorld = cameraFromPlate}, ++sequence_,
                           time_, {.surfaces = true});
    motion_ = standing();
    motion_.frameSize = kSize;
    motion_.sinceSequence = sequence_ - 1;
    frame.measuredMotion = scene::MeasuredMotion{.motion = &motion_};
    motionField_->update(frame);
    field_->update(frame, picture_, *motionField_, {});
  }

  /// The angles, in degrees, to the directions of a plate that has always been there, sorted.
  std::vector<double> errorsAfter(const std::function<glm::dmat4(int)>& place, Knows knows) {
    constexpr int kFrames = 24;
    useScene(knows);
    for (int i = 0; i <= kFrames; ++i) see(place(i));
    const std::vector<FieldTexel> found = read(field_->regions());
    useScene(Knows::kNothing);
    see(place(kFrames));
    const std::vector<FieldTexel> truth = read(field_->regions());
    std::vector<double> errors;
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 32; ++x) {
        bool isInside = true;
        for (const glm::ivec2 corner : {glm::ivec2(-4, -4), {12, -4}, {-4, 12}, {12, 12}}) {
          isInside = isInside && onPlate({8.0 * x + corner.x, 8.0 * y + corner.y}, place(kFrames));
        }
        const std::size_t at = placeOf(x, y);
        if (!isInside || truth[at].known < 0.5) continue;
        errors.push_back(degrees(oracles::angleBetween(found[at].tensor, truth[at].tensor)));
      }
    }
    std::ranges::sort(errors);
    return errors;
  }

  void expectFollowed(const std::function<glm::dmat4(int)>& place) {
    for (const Knows knows : {Knows::kPlane, Knows::kRealThing}) {
      const std::vector<double> errors = errorsAfter(place, knows);
      ASSERT_GT(errors.size(), 20U);
      EXPECT_LT(errors[errors.size() / 2], 1.0);
      EXPECT_LT(errors[errors.size() * 95 / 100], 3.0);
    }
  }

  scene::Scene scene_;
  std::optional<scene::ArFrameRenderer> renderer_;
  gpu::Texture picture_;
};

TEST_F(TensorPlanes, DirectionsRollWithTheSurface) {
  const auto place = [](int frame) { return rolled(0.03 * frame); };
  expectFollowed(place);
  const std::vector<double> lagging = errorsAfter(place, Knows::kNothing);
  EXPECT_GT(lagging[lagging.size() / 2], 5.0) << "the control: nobody knows the plate";
}

/// Turned away from the camera, its lines are sheared.
TEST_F(TensorPlanes, DirectionsTiltWithTheSurface) {
  const auto place = [](int frame) { return tilted(-0.2 + 0.045 * frame); };
  expectFollowed(place);
  const std::vector<double> lagging = errorsAfter(place, Knows::kNothing);
  EXPECT_GT(lagging[lagging.size() * 95 / 100], 5.0) << "the control";
}

}  // namespace
}  // namespace pleinair::marks
