#pragma once

#include <cstddef>
#include <numbers>
#include <optional>

#include "pipeline/marks/movers/motion_layers.h"
#include "tests/gpu/marks/tensor_fixture.h"

namespace pleinair::marks {

inline double degrees(double radians) {
  return radians * 180.0 / std::numbers::pi;
}

/// The index of a region, with 32 in a row.
inline std::size_t placeOf(int x, int y) {
  return static_cast<std::size_t>(y) * 32U + static_cast<std::size_t>(x);
}

/// A tensor field of pictures that are made up.
class TensorFieldFixture : public TensorTest {
 protected:
  static constexpr TensorFieldOptions kNoMemory{.memory = hal::Duration(0), .slack = 0.0};

  void SetUp() override {
    TensorTest::SetUp();
    if (IsSkipped()) return;
    motionField_.emplace(library_, kSize);
    field_.emplace(library_, kSize);
  }

  void update(const hal::Image& picture, const tracking::ImageMotion& motion = standing(),
              const TensorFieldOptions& options = {}, hal::Duration step = kStep) {
    const gpu::Texture texture = support::textureOf(picture.view());
    const scene::ArFrame frame = frameOf(texture, motion, step);
    motionField_->update(frame);
    if (layers_) layers_->update(frame, *motionField_);
    field_->update(frame, texture, *motionField_, options, layers_ ? &*layers_ : nullptr);
  }

  std::optional<MotionField> motionField_;
  std::optional<MotionLayers> layers_;  ///< empty: movers are not told apart
  std::optional<TensorField> field_;
};

}  // namespace pleinair::marks
