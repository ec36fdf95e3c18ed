#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

#include "pipeline/marks/movers/motion_layers.h"
#include "tests/gpu/marks/anchor_life_fixture.h"
#include "tests/gpu/marks/wall_and_disc.h"
#include "tests/support/gl_test.h"

namespace pleinair::marks {

inline std::vector<glm::vec4> texelsOf(const gpu::Texture& texture) {
  const std::vector<float> numbers = support::readRgba32f(texture);
  std::vector<glm::vec4> texels;
  for (std::size_t i = 0; i + 3 < numbers.size(); i += 4) {
    texels.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]);
  }
  return texels;
}

/// Layers, motion and anchors of pictures of a wall, and of a disc that moves before it.
class MotionLayersTest : public AnchorLife {
 protected:
  void SetUp() override {
    AnchorLife::SetUp();
    if (IsSkipped()) return;
    layers_.emplace(library_, kSize);
  }

  void see(const View& view, glm::dvec2 step = glm::dvec2(0.0), hal::FrameSize size = kSize,
           const scene::PoseSet& poses = {}) {
    seeImage(seen(view, size, seed_ + 1), step, poses);
  }
  void seeImage(const hal::Image& image, glm::dvec2 step = glm::dvec2(0.0),
                const scene::PoseSet& poses = {}) {
    seeImage(image, seed_ == 0 ? tracking::ImageMotion{} : panning(step.x, step.y), poses);
  }
  void seeImage(const hal::Image& image, const tracking::ImageMotion& motion,
                const scene::PoseSet& poses = {}) {
    ++seed_;
    picture_ = support::textureOf(image.view());
    const scene::ArFrame frame = compose(*renderer_, poses, motion);
    field_->update(frame);
    layers_->update(frame, *field_);
    set_->advance(frame, *field_, hold_, &*layers_);
  }

  enum class Texture { kWhole, kOutline };

  /// A frame with dense flow: the wall rests, and the disc has moved by `step` to the right. The
  /// flow reaches beyond the disc's outline, as measured flow does. Where the disc has no texture,
  /// it says that nothing moves.
  void seeDiscMoved(const View& view, glm::dvec2 step, Texture texture = Texture::kWhole) {
    seeDiscMoved(seen(view, kSize, seed_ + 1), view, step, texture);
  }
  void seeDiscMoved(const hal::Image& image, const View& view, glm::dvec2 step, Texture texture) {
    constexpr hal::FrameSize kNodes{40, 30};
    constexpr double kNodePx = 8.0;
    constexpr float kErrorPx = 0.1F;
    constexpr double kPlain = 24.0;
    constexpr double kFront = 24.0;
    const double reach = view.radius + 12.0;
    std::vector<glm::vec4> forward;
    std::vector<glm::vec4> backward;
    for (int y = 0; y < kNodes.height; ++y) {
      for (int x = 0; x < kNodes.width; ++x) {
        const glm::dvec2 px = kNodePx * (glm::dvec2(x, y) + 0.5);
        const auto isSeenToMove = [&](glm::dvec2 disc) {
          const double away = glm::distance(px, disc);
          const bool isOutline = away >= kPlain && px.x < disc.x + kFront;
          return away < reach && (texture == Texture::kWhole || isOutline);
        };
        const bool wasDisc = isSeenToMove(view.disc - step);
        const bool isDisc = isSeenToMove(view.disc);
        forward.emplace_back(wasDisc ? glm::vec2(step) : glm::vec2(0.0F), kErrorPx, 0.0F);
        backward.emplace_back(isDisc ? glm::vec2(-step) : glm::vec2(0.0F), kErrorPx, 0.0F);
      }
    }
    tracking::ImageMotion motion = panning(0.0, 0.0);
    motion.picture->errorPx = 1.0;  // where the flow is known, it is the better source
    motion.flow = {
        .nodes = kNodes, .stepPx = glm::vec2(kNodePx), .forward = forward, .backward = backward};
    seeImage(image, motion);
  }

  /// Frames 0.1 s apart.
  void rest(const View& view, hal::Duration time) {
    constexpr hal::Duration kLongStep = std::chrono::milliseconds(100);
    for (hal::Duration t{0}; t < time; t += kLongStep) {
      time_ += kLongStep - kStep;
      see(view);
    }
  }

  /// Over the cells: how many are movers, how many should be, and how many are both.
  struct Overlap {
    int found = 0;
    int wanted = 0;
    int both = 0;
    double iou() const { return static_cast<double>(both) / std::max(found + wanted - both, 1); }
  };
  Overlap overlapWith(const View& view) const {
    const std::vector<glm::vec4> labels = texelsOf(layers_->labels());
    const int width = layers_->labels().size().width;
    Overlap overlap;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const auto index = static_cast<int>(i);
      const glm::dvec2 px = (glm::dvec2(index % width, index / width) + 0.5) *
                            static_cast<double>(MotionLayers::kCellPixels);
      const bool isDisc = glm::distance(px, view.disc) < view.radius;
      const bool isMover = labels[i].r > 0.5F;
      overlap.found += isMover ? 1 : 0;
      overlap.wanted += isDisc ? 1 : 0;
      overlap.both += isMover && isDisc ? 1 : 0;
    }
    return overlap;
  }
  int movers() const { return overlapWith({}).found; }

  std::optional<MotionLayers> layers_;
  AnchorHold hold_;

 private:
  unsigned seed_ = 0;
};

}  // namespace pleinair::marks
