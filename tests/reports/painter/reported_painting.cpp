#include "tests/reports/painter/reported_painting.h"

#include <algorithm>
#include <string>

namespace pleinair {
namespace {

/// Copies the colours of pixels; a pixel of either image may have more bytes.
void copyColours(hal::ImageView from, std::size_t fromBytes, hal::Image& to, std::size_t toBytes) {
  for (int y = 0; y < to.size().height; ++y) {
    const auto source = from.row(0, y);
    const auto target = to.row(0, y);
    for (std::size_t x = 0; x < target.size() / toBytes; ++x) {
      std::copy_n(&source[fromBytes * x], 3, &target[toBytes * x]);
    }
  }
}

}  // namespace

void ReportedPainting::set(std::string_view parameter, std::string_view value) {
  style_.setParameters(style_.parameters().with(std::string(parameter), std::string(value)));
}

void ReportedPainting::paint(const hal::Image& rgb, glm::dvec2 movedPx) {
  hal::Image rgba({.pixelFormat = hal::PixelFormat::kRgba8, .size = rgb.size()});
  std::ranges::fill(rgba.plane(0), std::uint8_t{255});
  copyColours(rgb.view(), 3, rgba, 4);
  const gpu::Texture texture = support::textureOf(rgba.view());
  tracking::ImageMotion motion{.frameSize = rgb.size(), .sinceSequence = number_};
  motion.picture = tracking::ImageHomography{
      .currentFromPrevious = glm::dmat3(1, 0, 0, 0, 1, 0, movedPx.x, movedPx.y, 1),
      .errorPx = 0.01};
  ++number_;
  scene::ArFrame frame{
      .colour = &texture,
      .sequence = number_,
      .captureTime = hal::TimePoint(hal::Duration(33'333'333) * static_cast<int>(number_))};
  frame.measuredMotion = scene::MeasuredMotion{.motion = &motion};
  painted_ = &style_.paint(frame, "");
}

hal::Image ReportedPainting::picture() const {
  const hal::Image rgba = support::readRgba8(*painted_);
  hal::Image rgb({.pixelFormat = hal::PixelFormat::kRgb8, .size = rgba.size()});
  copyColours(rgba.view(), 4, rgb, 3);
  return rgb;
}

std::vector<marks::Anchor> ReportedPainting::anchors(std::size_t layer) const {
  return style_.layer(layer).anchors.read();
}

std::vector<marks::StrokeSlot> ReportedPainting::strokes(std::size_t layer) const {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  return support::readBuffer<marks::StrokeSlot>(style_.layer(layer).strokes.strokes());
}

std::vector<marks::StrokeInstance> ReportedPainting::instances(std::size_t layer) const {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  const marks::StrokeSet& strokes = style_.layer(layer).strokes;
  auto instances = support::readBuffer<marks::StrokeInstance>(strokes.instances());
  instances.resize(support::readBuffer<std::uint32_t>(strokes.command())[1]);
  return instances;
}

}  // namespace pleinair
