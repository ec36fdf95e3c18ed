// The tensors of virtual objects: they go with their object and leave nothing behind.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/marks/tensor_field_fixture.h"
#include "tests/oracles/tensor_oracle.h"

namespace pleinair::marks {
namespace {

/// A quad before a picture that stands, both textured.
class TensorModels : public TensorFieldFixture {
 protected:
  static constexpr double kHalfSide = 28.0;

  /// Where the quad is: its middle, and by what it is turned.
  struct Place {
    glm::dvec2 middle{0.0};
    double angle = 0.0;
  };
  static glm::dvec2 onQuad(glm::dvec2 px, const Place& place) {
    const glm::dvec2 arm = px - place.middle;
    const double c = std::cos(place.angle);
    const double s = std::sin(place.angle);
    return {c * arm.x + s * arm.y, c * arm.y - s * arm.x};
  }
  static glm::dvec2 fromQuad(glm::dvec2 point, const Place& place) {
    const double c = std::cos(place.angle);
    const double s = std::sin(place.angle);
    return place.middle + glm::dvec2(c * point.x - s * point.y, s * point.x + c * point.y);
  }
  static bool isQuad(glm::dvec2 px, const Place& place) {
    const glm::dvec2 point = glm::abs(onQuad(px, place));
    return std::max(point.x, point.y) < kHalfSide;
  }
  /// Rings, so that the directions differ from place to place.
  static double quadLuma(glm::dvec2 point) {
    return 0.5 + 0.3 * std::sin(0.5 * glm::distance(point, glm::dvec2(-48.0, -14.0)));
  }
  static double wall(glm::dvec2 px) { return variedLuma(px); }

  /// Sees the quad, if it is there; it was at `before`. `tellsMotion`: as its surface tells.
  void see(const std::optional<Place>& place, const std::optional<Place>& before = {},
           bool tellsMotion = true) {
    const hal::Image image = greyPicture(kSize, [&](glm::dvec2 px) {
      if (!place || !isQuad(px, *place)) return wall(px);
      return isPlain_ ? 0.5 : quadLuma(onQuad(px, *place));
    });
    std::vector<std::uint32_t> ids;
    std::vector<std::uint32_t> forms;  // labels without directions
    std::vector<glm::vec4> moved;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const glm::dvec2 px(x + 0.5, y + 0.5);
        const bool isIt = place && isQuad(px, *place);
        ids.push_back(isIt ? object_ << scene::kTriangleBits : 0U);
        forms.push_back(isIt ? object_ | line_ : 0U);
        glm::dvec2 by(0.0);
        if (isIt && before && tellsMotion) by = px - fromQuad(onQuad(px, *place), *before);
        moved.emplace_back(by, 0.0, isIt && before ? 1.0 : 0.0);
      }
    }
    colour_ = support::textureOf(image.view());
    const auto width = static_cast<std::size_t>(kSize.width);
    ids_ = gpu::Texture(gpu::TextureFormat::kR32ui, kSize);
    forms_ = gpu::Texture(gpu::TextureFormat::kR32ui, kSize);
    forms_.upload({reinterpret_cast<const std::uint8_t*>(forms.data()), 4 * forms.size()},
                  4 * width);
    ids_.upload({reinterpret_cast<const std::uint8_t*>(ids.data()), 4 * ids.size()}, 4 * width);
    moved_ = gpu::Texture(gpu::TextureFormat::kRgba32f, kSize);
    moved_.upload({reinterpret_cast<const std::uint8_t*>(moved.data()), 16 * moved.size()},
                  16 * width);
    hal::Image normals({.pixelFormat = hal::PixelFormat::kRgba8, .size = kSize});
    for (std::size_t i = 0; i < normals.plane(0).size(); ++i) {
      normals.plane(0)[i] = normal_.at(i % 4);
    }
    normals_ = support::textureOf(normals.view());
    scene::ArFrame frame = frameOf(colour_);
    frame.hasObjects = place.has_value();
    frame.ids = &ids_;
    frame.forms = &forms_;
    frame.normalFocus = &normals_;
    frame.motion = scene::SurfaceMotion{.texture = &moved_};
    motionField_->update(frame);
    field_->update(frame, colour_, *motionField_, {.form = form_});
  }

  /// The angles, in degrees, between the quad's directions and those of one that stands there, over
  /// its regions, sorted. Forgets the past.
  std::vector<double> errorsOnQuad(const Place& place) {
    const std::vector<FieldTexel> found = read(field_->resolvedModels(0));
    field_->reset();
    see(place);
    const std::vector<FieldTexel> still = read(field_->resolvedModels(0));
    std::vector<double> errors;
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 32; ++x) {
        const glm::dvec2 point = glm::abs(onQuad({8.0 * x + 4.0, 8.0 * y + 4.0}, place));
        if (std::max(point.x, point.y) > kHalfSide - 6.0) continue;
        const std::size_t at = placeOf(x, y);
        errors.push_back(degrees(oracles::angleBetween(found[at].tensor, still[at].tensor)));
      }
    }
    std::ranges::sort(errors);
    return errors;
  }

  std::uint32_t object_ = 1;
  std::uint32_t line_ = 0;  // the direction of its form, as in surface_form.glsl
  bool isPlain_ = false;
  double form_ = 0.0;
  std::array<std::uint8_t, 4> normal_{128, 128, 255, 0};  // towards the camera
  gpu::Texture colour_;
  gpu::Texture ids_;
  gpu::Texture forms_;
  gpu::Texture moved_;
  gpu::Texture normals_;
};

TEST_F(TensorModels, DirectionsGoWithTheModel) {
  for (const bool tellsMotion : {true, false}) {
    field_->reset();
    Place place{{40.0, 60.0}};
    see(place);
    for (int i = 0; i < 30; ++i) {
      const Place before = place;
      place.middle.x += 5.0;
      see(place, before, tellsMotion);
    }
    const std::vector<double> errors = errorsOnQuad(place);
    ASSERT_GT(errors.size(), 20U);
    const double median = errors[errors.size() / 2];
    if (tellsMotion) {
      EXPECT_LT(median, 1.0);
      EXPECT_LT(errors.back(), 3.0);
    } else {
      EXPECT_GT(errors.back(), 6.0) << "the control";
    }
  }
}

TEST_F(TensorModels, DirectionsTurnWithTheModel) {
  for (const bool tellsMotion : {true, false}) {
    field_->reset();
    Place place{{128.0, 64.0}};
    see(place);
    for (int i = 0; i < 30; ++i) {
      const Place before = place;
      place.angle += 0.03;
      see(place, before, tellsMotion);
    }
    const std::vector<double> errors = errorsOnQuad(place);
    ASSERT_GT(errors.size(), 20U);
    const double median = errors[errors.size() / 2];
    if (tellsMotion) {
      EXPECT_LT(median, 1.0);
      EXPECT_LT(errors.back(), 3.0);
    } else {
      EXPECT_GT(median, 5.0) << "the control";
    }
  }
}

/// Neither while the model passes nor afterwards: beside it and where it was, the background's
/// directions are those of a picture without it.
TEST_F(TensorModels, AModelLeavesNothingOnTheBackground) {
  for (int i = 0; i < 30; ++i) see({});
  const std::vector<FieldTexel> without = read(field_->resolved(0));
  Place place{{-30.0, 60.0}};
  for (int i = 0; i < 73; ++i) {  // it leaves in frame 62
    const Place before = place;
    place.middle.x += 5.0;
    see(place, before);
    const std::vector<FieldTexel> now = read(field_->resolved(0));
    double worst = 0.0;
    for (std::size_t at = 0; at < now.size(); ++at) {
      if (without[at].known < 0.5 || glm::length(without[at].tensor) < 0.05) continue;
      worst = std::max(worst, degrees(oracles::angleBetween(now[at].tensor, without[at].tensor)));
    }
    EXPECT_LT(worst, i < 71 ? 9.0 : 1.0) << "frame " << i;
  }
}

/// The past of a region is that of its patch; another one's does not count.
TEST_F(TensorModels, AnotherPatchBeginsAnew) {
  const Place level{{128.0, 64.0}};
  const Place turned{{128.0, 64.0}, 1.0};
  see(level);
  see(turned, turned);
  const std::vector<double> held = errorsOnQuad(turned);
  ASSERT_FALSE(held.empty());
  EXPECT_GT(held[held.size() / 2], 5.0) << "the control: the same patch, whose past counts";
  field_->reset();
  see(level);
  object_ = 2;
  see(turned, turned);
  EXPECT_LT(errorsOnQuad(turned).back(), 0.01);
}

/// On plain surfaces strokes follow the form, towards a silhouette the silhouette.
TEST_F(TensorModels, FormLeadsWhereThePictureDoesNot) {
  const Place place{{128.0, 64.0}};
  constexpr double kAngle = 0.7;  // of the line
  line_ = static_cast<std::uint32_t>(std::lround(kAngle / std::numbers::pi * 4096.0)) << 12U |
          31U << 24U;
  isPlain_ = true;
  const auto worstOff = [&](double gradient) {
    see(place);
    const glm::dvec2 truth(std::cos(2.0 * gradient), std::sin(2.0 * gradient));
    const std::vector<FieldTexel> found = read(field_->resolvedModels(0));
    double worst = 0.0;
    for (const glm::ivec2 at : {glm::ivec2(14, 6), {16, 8}, {17, 9}, {15, 7}}) {
      worst =
          std::max(worst, degrees(oracles::angleBetween(found[placeOf(at.x, at.y)].tensor, truth)));
    }
    field_->reset();
    return worst;
  };
  const double across = kAngle + std::numbers::pi / 2.0;
  EXPECT_GT(worstOff(across), 10.0) << "the control: form has no weight";
  form_ = 0.5;
  EXPECT_LT(worstOff(across), 1.0);
  normal_ = {255, 128, 128, 0};  // to the right: the silhouette is upright
  EXPECT_LT(worstOff(0.0), 1.0);
}

/// The limit of a strong edge is that of the camera's picture.
TEST_F(TensorModels, AModelMovesNoLayerOfTheBackground) {
  see({});
  const std::vector<FieldTexel> without = read(field_->resolved(0));
  see(Place{{128.0, 64.0}});
  const std::vector<FieldTexel> with = read(field_->resolved(0));
  for (const glm::ivec2 at : {glm::ivec2(4, 8), {8, 4}, {28, 8}, {26, 12}}) {
    EXPECT_NEAR(with[placeOf(at.x, at.y)].detail, without[placeOf(at.x, at.y)].detail, 2e-3);
  }
}

}  // namespace
}  // namespace pleinair::marks
