#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

#include "hal/image.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/styles/painterly/painterly.h"
#include "tests/gpu/marks/stroke_fixture.h"

namespace pleinair {

/// A painting of images with given motion, whose strokes can be read. `library` has the shaders of
/// all styles; a GL context is current.
class ReportedPainting {
 public:
  explicit ReportedPainting(const gpu::ShaderLibrary& library) : style_(library) {}

  void set(std::string_view parameter, std::string_view value);
  /// Paints the next frame, RGB8, 1/30 s after the previous one, displaced by `movedPx` since.
  void paint(const hal::Image& rgb, glm::dvec2 movedPx);
  /// The last painted image, RGB8.
  hal::Image picture() const;

  /// For each layer, from coarse to fine: its strokes by slot, and in painting order.
  std::size_t layerCount() const { return style_.layerCount(); }
  std::vector<marks::Anchor> anchors(std::size_t layer) const;
  std::vector<marks::StrokeSlot> strokes(std::size_t layer) const;
  std::vector<marks::StrokeInstance> instances(std::size_t layer) const;

 private:
  styles::Painterly style_;
  const gpu::Texture* painted_ = nullptr;
  std::uint64_t number_ = 0;
};

}  // namespace pleinair
