#include "tests/reports/overlay/label_walkaround.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/scene/models/limits.h"

namespace pleinair::overlay_truth {
namespace {

constexpr hal::FrameSize kSize{640, 480};
constexpr glm::ivec2 kLabelPx{64, 24};

/// Slope of a line through equally spaced values, per second.
double slopeOf(const std::vector<double>& values) {
  const double middle = 0.5 * static_cast<double>(values.size() - 1);
  double product = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double t = (static_cast<double>(i) - middle) * hal::toSeconds(kWalkPeriod);
    product += t * values[i];
    square += t * t;
  }
  return product / square;
}

}  // namespace

struct LabelWalkaround::LabelBox {
  glm::ivec2 low, high;
  bool holds(int x, int y) const { return x >= low.x && y >= low.y && x < high.x && y < high.y; }
  int shared(const LabelBox& other) const {
    const glm::ivec2 size = glm::min(high, other.high) - glm::max(low, other.low);
    return std::max(0, size.x) * std::max(0, size.y);
  }
};

double LabelTrack::driftPxPerSecond() const {
  return std::hypot(slopeOf(x), slopeOf(y));
}

LabelWalkaround::LabelWalkaround(bool onEach)
    : bench_({.size = kSize, .framePeriod = kWalkPeriod, .shot = hal::SyntheticShot::kWalkaround},
             {0, 1, 2, 3, 4}),
      film_({.folder = kGearboxProcedure, .step = "end_bolts_off"}, bench_.scene),
      painter_({.pictureSize = kSize,
                .scene = bench_.scene,
                .style = "none",
                .readsSurfaces = onEach,
                .overlay = true,
                .machine = film_.machine()}),
      parameters_(painter_.defaultParameters()) {
  overlay::OverlayContent content = *film_.at(hal::Duration{0}, kSize);
  const hal::Image picture(
      {.pixelFormat = hal::PixelFormat::kRgba8, .size = {kLabelPx.x, kLabelPx.y}});
  content.labels.front().picture = picture;
  if (onEach) {
    const std::vector<std::size_t> parts = content.labels.front().parts;
    content.labels.clear();
    for (const std::size_t part : parts) {
      content.labels.push_back({.picture = picture, .parts = {part}});
    }
  }
  parameters_.overlay = std::make_shared<const overlay::OverlayContent>(std::move(content));
  tracks.resize(parameters_.overlay->labels.size());
}

void LabelWalkaround::play(int frames) {
  for (int i = 0; i < frames; ++i) {
    const auto frame = bench_.next().first;
    const Picture picture = hal::orThrow(painter_.paint(frame, parameters_));
    if (picture.overlay->trust.opacity < 1.0F) continue;
    ++shown;
    const auto labels = painter_.overlayLabels();
    std::vector<LabelBox> boxes;
    for (const overlay::PlacedLabel& each : labels) {
      if (each.isShown) boxes.push_back({each.topLeft, each.topLeft + kLabelPx});
    }
    placed += static_cast<int>(boxes.size());
    countOverlaps(boxes);
    for (std::size_t k = 0; k < labels.size(); ++k) {
      if (labels[k].isShown) follow(k, labels[k], bench_.trueCameraFromModel(frame.sequence));
    }
  }
}

void LabelWalkaround::countOverlaps(std::span<const LabelBox> boxes) {
  if (boxes.size() < 2) return;
  for (std::size_t a = 0; a < boxes.size(); ++a) {
    for (std::size_t b = a + 1; b < boxes.size(); ++b) overlapPx += boxes[a].shared(boxes[b]);
  }
  const scene::SurfaceSnapshot surfaces = hal::orThrow(painter_.surfaces());
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const std::uint32_t id = surfaces.id(x, y);
      if (id >> scene::kTriangleBits != 1) continue;
      const auto* part = scene::partOfTriangle(model(), id & (scene::kMaxTriangles - 1));
      const auto index = static_cast<std::size_t>(part - model().parts.data());
      if (parameters_.overlay->looks[index] != overlay::PartLook::kFocus) continue;
      ++partPx;
      coveredPx += std::ranges::any_of(boxes, [&](const auto& box) { return box.holds(x, y); });
    }
  }
}

void LabelWalkaround::follow(std::size_t index, const overlay::PlacedLabel& label,
                             const glm::dmat4& cameraFromModel) {
  // It leaves its pixel after one, and the pose is off by a little.
  constexpr double kLaidOutAgainPx = 2.0;
  LabelTrack& track = tracks[index];
  const glm::dvec2 centre = glm::dvec2(label.topLeft) + 0.5 * glm::dvec2(kLabelPx);
  const auto& camera = *bench_.scene.camera;
  const auto awayFrom = [&](const glm::dvec3& point) {
    return centre - camera.project(glm::dvec3(cameraFromModel * glm::dvec4(point, 1.0)));
  };
  const bool isNew = track.x.empty();
  const glm::dvec2 away = isNew ? glm::dvec2(0.0) : awayFrom(track.point);
  const bool jumps = glm::length(away) > kLaidOutAgainPx;
  if (isNew || jumps) {
    LabelTrack next;
    next.completed = std::move(track.completed);
    track.completed.clear();
    if (jumps) next.completed.push_back(std::move(track));
    track = std::move(next);
    double depth = HUGE_VAL;  // of the nearest part
    for (const std::size_t part : parameters_.overlay->labels[index].parts) {
      const glm::dvec4 ofPart(overlay::shapeOf(model(), part).centre, 1.0);
      depth = std::min(depth, (cameraFromModel * ofPart).z);
    }
    const glm::dvec3 at = depth * camera.unproject(centre).value();
    track.point = glm::dvec3(glm::inverse(cameraFromModel) * glm::dvec4(at, 1.0));
  }
  const glm::dvec2 now = awayFrom(track.point);
  track.x.push_back(now.x);
  track.y.push_back(now.y);
}

}  // namespace pleinair::overlay_truth
