#include "pipeline/measure/input/model_motion.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace pleinair::measure {
namespace {

constexpr std::size_t kKeptFrames = 12;
/// Within a model, a larger difference between neighbouring pixels is a step from one surface to
/// another. A wheel that turns by 24° between two frames (the gearbox in ten) has 0.42 px a pixel.
constexpr float kStepPixels = 0.5F;
constexpr float kStepPixelsPerFrame = 0.1F;
/// The surface that a later frame shows at the pixel next to a point, at most 0.71 px away, comes
/// from that close to where the point was, as long as its picture shrinks by less than a half.
constexpr float kSamePixels = 1.5F;

int objectOf(int id) {
  return id >> PaintedModels::kTriangleBits;
}

/// A displacement for each pixel, 255 in `seen` where it is known and visible in both frames.
struct Field {
  explicit Field(cv::Size size) : px(size, cv::Vec2f()), seen(size, 0) {}
  cv::Mat2f px;
  cv::Mat1b seen;
};

/// The displacement of the surface at a pixel of one frame to another one; nothing where it is
/// hidden or out of sight there.
std::optional<cv::Vec2f> displacementOf(cv::Point at, const PaintedModels& from,
                                        const PaintedModels& to) {
  const int id = from.ids(at);
  const std::optional<cv::Point2f> place = to.place(id, from.barycentrics(at));
  if (!place) return std::nullopt;
  const cv::Point there(cvRound(place->x), cvRound(place->y));
  if (!cv::Rect({}, to.ids.size()).contains(there)) return std::nullopt;
  const int seen = to.ids(there);
  if (objectOf(seen) != objectOf(id)) return std::nullopt;
  const std::optional<cv::Point2f> origin = from.place(seen, to.barycentrics(there));
  if (!origin || cv::norm(*origin - cv::Point2f(at)) > static_cast<double>(kSamePixels)) {
    return std::nullopt;
  }
  return cv::Vec2f(place->x - static_cast<float>(at.x), place->y - static_cast<float>(at.y));
}

/// Whether a model is seen at one of the four pixels around a point.
bool isCovered(const cv::Mat1i& ids, cv::Point2f at) {
  const cv::Point corner(cvFloor(at.x), cvFloor(at.y));
  const cv::Rect around = cv::Rect(corner, cv::Size(2, 2)) & cv::Rect({}, ids.size());
  return !around.empty() && cv::countNonZero(ids(around)) > 0;
}

/// Takes the pixels beside another object's out.
void clearOutlines(const cv::Mat1i& ids, cv::Mat1b& seen) {
  for (int y = 0; y < ids.rows; ++y) {
    for (int x = 0; x < ids.cols; ++x) {
      const int object = objectOf(ids(y, x));
      const bool right = x + 1 < ids.cols && objectOf(ids(y, x + 1)) != object;
      const bool below = y + 1 < ids.rows && objectOf(ids(y + 1, x)) != object;
      if (right || below) seen(y, x) = 0;
    }
  }
}

float stepPixels(std::uint64_t from, std::uint64_t to) {
  const auto apart = static_cast<float>(std::max(from, to) - std::min(from, to));
  return std::max(kStepPixels, kStepPixelsPerFrame * apart);
}

}  // namespace

cv::Mat1b PaintedModels::mask() const {
  cv::Mat1b shown;
  cv::compare(ids, 0, shown, cv::CMP_NE);
  return shown;
}

void ModelMotion::add(std::uint64_t frame, PaintedModels models) {
  assert(models.ids.size() == models.barycentrics.size());
  recent_.insert_or_assign(frame, std::move(models));
  if (recent_.size() > kKeptFrames) recent_.erase(recent_.begin());
  cameraMaps_.clear();
}

std::string ModelMotion::description() const {
  return camera_ == nullptr ? "the models' own motion; the camera's is not known"
                            : camera_->description() + ", and the models' own motion";
}

hal::Result<const MotionMap*> ModelMotion::ofCamera(std::uint64_t from, std::uint64_t to) {
  if (camera_ == nullptr) return nullptr;
  if (const auto known = cameraMaps_.find({from, to}); known != cameraMaps_.end()) {
    return &known->second;
  }
  hal::Result<MotionMap> map = camera_->between(from, to);
  if (!map) return tl::unexpected(map.error());
  return &cameraMaps_.emplace(std::pair(from, to), std::move(*map)).first->second;
}

hal::Result<MotionMap> ModelMotion::between(std::uint64_t from, std::uint64_t to) {
  const hal::Result<const MotionMap*> camera = ofCamera(from, to);
  if (!camera) return tl::unexpected(camera.error());
  const MotionMap* const behind = *camera;
  const PaintedModels& earlier = recent_.at(from);
  const PaintedModels& later = recent_.at(to);
  const cv::Size size = earlier.ids.size();
  Field field(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (earlier.ids(y, x) != 0) {
        const auto by = displacementOf({x, y}, earlier, later);
        field.px(y, x) = by.value_or(cv::Vec2f());
        field.seen(y, x) = by ? 255 : 0;
        continue;
      }
      if (behind == nullptr) continue;
      const cv::Vec2f by = behind->shift ? cv::Vec2f(static_cast<float>(behind->shift->x),
                                                     static_cast<float>(behind->shift->y))
                                         : behind->displacement(y, x);
      const cv::Point2f there(static_cast<float>(x) + by[0], static_cast<float>(y) + by[1]);
      field.px(y, x) = by;
      field.seen(y, x) = isCovered(later.ids, there) ? 0 : 255;
    }
  }
  clearOutlines(earlier.ids, field.seen);
  MotionMap map = fieldMap(field.px, field.seen, stepPixels(from, to));
  if (behind == nullptr || behind->shift) return map;
  // Where no model is seen, it is valid where the camera's is.
  cv::Mat1b known;
  cv::bitwise_or(behind->valid, earlier.mask(), known);
  cv::bitwise_and(map.valid, known, map.valid);
  return map;
}

MotionMap ModelMotion::ofModels(std::uint64_t from, std::uint64_t to) const {
  const PaintedModels& here = recent_.at(from);
  const PaintedModels& there = recent_.at(to);
  Field field(here.ids.size());
  for (int y = 0; y < here.ids.rows; ++y) {
    for (int x = 0; x < here.ids.cols; ++x) {
      if (here.ids(y, x) == 0) continue;
      const auto by = displacementOf({x, y}, here, there);
      if (!by) continue;
      field.px(y, x) = *by;
      field.seen(y, x) = 255;
    }
  }
  clearOutlines(here.ids, field.seen);
  return fieldMap(field.px, field.seen, stepPixels(from, to));
}

hal::Result<MotionMap> ModelMotion::forgettingModels(std::uint64_t from, std::uint64_t to) {
  const hal::Result<const MotionMap*> camera = ofCamera(from, to);
  if (!camera) return tl::unexpected(camera.error());
  const cv::Size size = recent_.at(from).ids.size();
  const MotionMap* const behind = *camera;
  if (behind != nullptr && !behind->shift) return *behind;
  const cv::Vec2f by = behind == nullptr ? cv::Vec2f()
                                         : cv::Vec2f(static_cast<float>(behind->shift->x),
                                                     static_cast<float>(behind->shift->y));
  return MotionMap{.shift = {}, .displacement = cv::Mat2f(size, by), .valid = cv::Mat1b(size, 255)};
}

}  // namespace pleinair::measure
