#include "pipeline/overlay/label_layout.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

namespace pleinair::overlay {
namespace {

using namespace std::chrono_literals;

constexpr hal::Duration kBadFor = 300ms;
constexpr hal::Duration kMoveOver = 200ms;
constexpr double kTurnDeg = 15.0;
constexpr double kScale = 1.1;
constexpr double kStaysWithinPx = 1.0;
constexpr double kGapPx = 14.0;   // between a part and its label
constexpr double kClearPx = 4.0;  // around a part
constexpr double kNearestMetres = 0.01;

glm::dvec3 inCamera(const LabelView& view, const glm::dvec3& point) {
  return glm::dvec3(view.cameraFromModel * glm::dvec4(point, 1.0));
}

PxBox pictureOf(const LabelView& view) {
  const hal::FrameSize size = view.camera->imageSize();
  return {glm::dvec2(0.0), glm::dvec2(size.width, size.height)};
}

PxBox around(const glm::dvec2& centre, const glm::dvec2& size) {
  return {centre - 0.5 * size, centre + 0.5 * size};
}

/// From the model to the camera, unit length.
glm::dvec3 towardCamera(const LabelView& view, const glm::dvec3& anchor) {
  const glm::dmat3 rotation(view.cameraFromModel);
  return glm::normalize(-(glm::transpose(rotation) * inCamera(view, anchor)));
}

/// How badly a label lies there; 0: well.
double badness(const LabelView& view, std::span<const LabelTarget> targets,
               std::span<const PlacedLabel> placed, std::size_t index, const PxBox& box) {
  double bad = 0.0;
  const PxBox picture = pictureOf(view);
  const double area = box.size().x * box.size().y;
  bad += 4.0 * (1.0 - picture.shared(box) / area);
  for (const PxBox& each : view.keepClear) bad += 2.0 * each.shared(box) / area;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (targets[i].box) bad += 3.0 * targets[i].box->grown(kClearPx).shared(box) / area;
    if (i == index || !placed[i].isShown) continue;
    const glm::dvec2 corner(placed[i].topLeft);
    bad += 3.0 * PxBox{corner, corner + targets[i].sizePx}.grown(2.0).shared(box) / area;
  }
  return bad;
}

/// The shortest way out of `from`, for a box that overlaps it.
glm::dvec2 wayOut(const PxBox& box, const PxBox& from) {
  const std::array<glm::dvec2, 4> ways{{{from.low.x - box.high.x, 0.0},
                                        {from.high.x - box.low.x, 0.0},
                                        {0.0, from.low.y - box.high.y},
                                        {0.0, from.high.y - box.low.y}}};
  return *std::ranges::min_element(ways, {},
                                   [](const glm::dvec2& way) { return glm::length(way); });
}

}  // namespace

std::span<const PlacedLabel> LabelLayout::place(const LabelView& view,
                                                std::span<const LabelTarget> targets) {
  if (slots_.size() != targets.size() || placed_.size() != targets.size()) {
    slots_.assign(targets.size(), {});
    placed_.assign(targets.size(), {});
  }
  targets = targets.first(std::min(targets.size(), kMost));
  for (std::size_t i = 0; i < targets.size(); ++i) {
    Slot& slot = slots_[i];
    if (!targets[i].box || inCamera(view, targets[i].anchor).z < kNearestMetres) {
      placed_[i].isShown = false;
      slot = {};
      continue;
    }
    if (!slot.isLaid || isStale(view, targets[i], slot)) layOut(view, targets, i);
    show(view, targets, i);
  }
  return placed_;
}

bool LabelLayout::isStale(const LabelView& view, const LabelTarget& target, Slot& slot) const {
  const double turned = glm::dot(slot.towardCamera, towardCamera(view, target.anchor));
  const double scale = glm::length(inCamera(view, target.anchor)) / slot.distance;
  if (turned < std::cos(glm::radians(kTurnDeg)) || scale > kScale || scale < 1.0 / kScale) {
    return true;
  }
  return slot.badSince && view.time - *slot.badSince >= kBadFor;
}

/// Chooses the best of places around the part, the one it has if that is nearly as good.
void LabelLayout::layOut(const LabelView& view, std::span<const LabelTarget> targets,
                         std::size_t index) {
  constexpr int kDirections = 16;
  constexpr double kRing = 40.0;  // px from one ring of places to the next
  Slot& slot = slots_[index];
  const LabelTarget& target = targets[index];
  const glm::dvec3 anchor = inCamera(view, target.anchor);
  const glm::dvec2 anchorPx = view.camera->project(anchor);
  const std::optional<glm::dvec2> before =
      slot.isLaid && slot.shown ? std::optional(glm::dvec2(*slot.shown) + 0.5 * target.sizePx)
                                : std::nullopt;
  const glm::dvec2 middle = pictureOf(view).centre();
  glm::dvec2 best = anchorPx;
  double least = std::numeric_limits<double>::max();
  for (int ring = 0; ring < 4; ++ring) {
    for (int i = 0; i < kDirections; ++i) {
      const double angle = glm::radians(360.0 * i / kDirections - 90.0);
      const glm::dvec2 way(std::cos(angle), std::sin(angle));
      const glm::dvec2 reach = 0.5 * (target.box->size() + target.sizePx) + kGapPx + kRing * ring;
      // To where the label's box leaves that of the part.
      const double along = std::min(reach.x / std::max(std::abs(way.x), 1e-6),
                                    reach.y / std::max(std::abs(way.y), 1e-6));
      const glm::dvec2 centre = target.box->centre() + along * way;
      double cost = 10.0 * badness(view, targets, placed_, index, around(centre, target.sizePx));
      cost += 0.004 * glm::length(centre - anchorPx);  // near the part
      cost += 0.3 * (1.0 + way.y);                     // above it rather than below
      cost += 0.0005 * glm::length(centre - middle);   // and not at the border
      if (before) cost += 0.004 * glm::length(centre - *before);
      if (cost >= least) continue;
      least = cost;
      best = centre;
    }
  }
  // On the plane through the anchor that faces the camera.
  const auto ray = view.camera->unproject(best);
  const glm::dvec3 at = ray ? anchor.z * *ray : anchor;
  slot.point = glm::dvec3(glm::inverse(view.cameraFromModel) * glm::dvec4(at, 1.0));
  slot.towardCamera = towardCamera(view, target.anchor);
  slot.distance = glm::length(anchor);
  slot.badSince.reset();
  slot.moved = before ? std::optional(view.time) : std::nullopt;
  slot.moveFrom = before ? *before - best : glm::dvec2(0.0);
  slot.isLaid = true;
}

void LabelLayout::show(const LabelView& view, std::span<const LabelTarget> targets,
                       std::size_t index) {
  Slot& slot = slots_[index];
  const LabelTarget& target = targets[index];
  const glm::dvec3 at = inCamera(view, slot.point);
  glm::dvec2 centre = view.camera->project({at.x, at.y, std::max(at.z, kNearestMetres)});
  if (slot.moved) {
    const double t = hal::toSeconds(view.time - *slot.moved) / hal::toSeconds(kMoveOver);
    const double rest = 1.0 - std::clamp(t, 0.0, 1.0);
    centre += rest * rest * (3.0 - 2.0 * rest) * slot.moveFrom;
    if (t >= 1.0) slot.moved.reset();
  }
  PxBox box = around(centre, target.sizePx);
  const double bad = badness(view, targets, placed_, index, box);
  if (bad < 0.02) {
    slot.badSince.reset();
  } else if (!slot.badSince) {
    slot.badSince = view.time;
  }
  // Never over a part or another label, even before it is laid out again.
  const auto leave = [&](const PxBox& taken) {
    if (!taken.grown(1.0).overlaps(box)) return;
    const glm::dvec2 way = wayOut(box, taken.grown(1.5));
    box = {box.low + way, box.high + way};
  };
  constexpr int kRounds = 4;  // out of one may be into another
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < index; ++i) {
      const glm::dvec2 low(placed_[i].topLeft);
      if (placed_[i].isShown) leave({low, low + targets[i].sizePx});
    }
    for (const LabelTarget& each : targets) {
      if (each.box) leave(*each.box);
    }
  }
  const glm::dvec2 corner = box.low;
  const bool stays = slot.shown && std::max(std::abs(corner.x - slot.shown->x),
                                            std::abs(corner.y - slot.shown->y)) <= kStaysWithinPx;
  if (!stays) slot.shown = glm::ivec2(glm::round(corner));
  PlacedLabel& placed = placed_[index];
  placed.isShown = true;
  placed.topLeft = *slot.shown;
  const glm::dvec2 low(placed.topLeft);
  const glm::dvec2 high = low + target.sizePx;
  const glm::dvec2 anchor = view.camera->project(inCamera(view, target.anchor));
  placed.leaderFrom = glm::clamp(anchor, low, high);
  // The leader ends where it meets the part's box, a little inside a large one.
  const PxBox& part = target.aim;
  const glm::dvec2 edge = glm::clamp(placed.leaderFrom, part.low, part.high);
  placed.leaderTo = glm::mix(edge, anchor, glm::length(part.size()) > 60.0 ? 0.45 : 0.1);
}

}  // namespace pleinair::overlay
