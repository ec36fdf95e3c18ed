#include "firmware_app/offline/measured_engine.h"

#include <cassert>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "pipeline/scene/models/limits.h"
#include "pipeline/scene/render/surface_snapshot.h"

namespace pleinair::app {
namespace {

static_assert(measure::PaintedModels::kTriangleBits == scene::kTriangleBits);

/// Occluders are left out: the camera's image is seen there.
measure::PaintedModels modelsOf(scene::SurfaceSnapshot snapshot) {
  const auto shown = std::make_shared<const scene::SurfaceSnapshot>(std::move(snapshot));
  const cv::Size size(shown->size().width, shown->size().height);
  measure::PaintedModels models{.ids = cv::Mat1i(size, 0),
                                .barycentrics = cv::Mat2f(size, cv::Vec2f()),
                                .place = {},
                                .changed = {}};
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const std::uint32_t id = shown->id(x, y);
      if (id == 0 || (id >> scene::kTriangleBits) >= scene::kRealObject) continue;
      const glm::vec2 at = shown->barycentrics(x, y);
      models.ids(y, x) = static_cast<int>(id);
      models.barycentrics(y, x) = {at.x, at.y};
    }
  }
  models.place = [shown](int id, const cv::Vec2f& at) -> std::optional<cv::Point2f> {
    const auto px = shown->place(static_cast<std::uint32_t>(id), {at[0], at[1]});
    if (!px) return std::nullopt;
    return cv::Point2f(static_cast<float>(px->x - 0.5), static_cast<float>(px->y - 0.5));
  };
  return models;
}

/// 255 where two RGB8 pictures of one size differ.
cv::Mat1b differing(const hal::Image& a, const hal::Image& b) {
  constexpr int kLevels = 4;
  const hal::FrameSize size = a.size();
  cv::Mat1b mask(size.height, size.width, std::uint8_t{0});
  const hal::ImageView left = a.view();
  const hal::ImageView right = b.view();
  for (int y = 0; y < size.height; ++y) {
    const auto in = left.row(0, y);
    const auto other = right.row(0, y);
    for (std::size_t i = 0; i < 3 * static_cast<std::size_t>(size.width); ++i) {
      if (std::abs(in[i] - other[i]) > kLevels) mask(y, static_cast<int>(i / 3)) = 255;
    }
  }
  return mask;
}

}  // namespace

hal::Result<measure::PaintedFrame> MeasuredEngine::paint(const hal::CapturedFrame& frame) {
  return options_.composer == nullptr ? paintAlone(frame) : paintComposed(frame);
}

hal::Result<measure::PaintedFrame> MeasuredEngine::paintAlone(const hal::CapturedFrame& frame) {
  const hal::Result<Picture> picture = painter_.paint(frame, parameters_);
  if (!picture) return tl::unexpected(picture.error());
  hal::Result<hal::Image> output = painter_.snapshot();
  if (!output) return tl::unexpected(output.error());
  hal::Result<std::vector<marks::Anchor>> anchors = painter_.anchors();
  if (!anchors) return tl::unexpected(anchors.error());
  hal::Result<std::optional<hal::Image>> movers;
  if (options_.readsMovers) movers = painter_.movers();
  if (!movers) return tl::unexpected(movers.error());
  measure::PaintedFrame painted{.input = {},
                                .output = std::move(*output),
                                .anchors = std::move(*anchors),
                                .movers = std::move(*movers)};
  if (options_.readsModels && options_.composer == nullptr) {
    if (auto read = readModels(painter_, frame, painted); !read) {
      return tl::unexpected(read.error());
    }
    return painted;
  }
  hal::Result<hal::Image> input = cameraPicture(painter_, frame);
  if (!input) return tl::unexpected(input.error());
  painted.input = std::move(*input);
  return painted;
}

/// The picture with models takes the place of the camera's.
hal::Result<measure::PaintedFrame> MeasuredEngine::paintComposed(const hal::CapturedFrame& frame) {
  Painter& composer = *options_.composer;
  const hal::Result<Picture> composed = composer.paint(frame, composer.defaultParameters());
  if (!composed) return tl::unexpected(composed.error());
  measure::PaintedFrame shown;
  if (auto read = readModels(composer, frame, shown); !read) return tl::unexpected(read.error());
  hal::CapturedFrame film = frame;
  film.image = shown.input.view();
  hal::Result<measure::PaintedFrame> painted = paintAlone(film);
  if (!painted) return painted;
  painted->models = std::move(shown.models);
  painted->camera = std::move(shown.camera);
  return painted;
}

hal::Result<void> MeasuredEngine::readModels(const Painter& shown, const hal::CapturedFrame& frame,
                                             measure::PaintedFrame& painted) const {
  hal::Result<hal::Image> composed = shown.composedSnapshot();
  if (!composed) return tl::unexpected(composed.error());
  hal::Result<hal::Image> camera = cameraPicture(shown, frame);
  if (!camera) return tl::unexpected(camera.error());
  hal::Result<scene::SurfaceSnapshot> surfaces = shown.surfaces();
  if (!surfaces) return tl::unexpected(surfaces.error());
  assert(surfaces->size() == size_);
  painted.input = std::move(*composed);
  painted.camera = std::move(*camera);
  painted.models = modelsOf(std::move(*surfaces));
  cv::bitwise_or(painted.models->mask(), differing(painted.input, painted.camera),
                 painted.models->changed);
  return {};
}

hal::Result<hal::Image> MeasuredEngine::cameraPicture(const Painter& painter,
                                                      const hal::CapturedFrame& frame) const {
  const hal::FrameFormat& format = frame.image.format;
  if (format.pixelFormat == hal::PixelFormat::kRgb8 && format.size == size_) {
    return hal::Image(frame.image);
  }
  return painter.cameraSnapshot();
}

void MeasuredEngine::reset() {
  painter_.reset();
  if (options_.composer != nullptr) options_.composer->reset();
}

}  // namespace pleinair::app
