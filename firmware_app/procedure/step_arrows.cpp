#include "firmware_app/procedure/step_arrows.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <optional>

#include <glm/geometric.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/overlay/line_shapes.h"
#include "pipeline/overlay/part_shape.h"
#include "pipeline/overlay/reserved_colours.h"

namespace pleinair::app {
namespace {

using overlay::ArrowKind;
using procedure::Step;

std::optional<ArrowKind> arrowOf(const Step& step) {
  switch (step.motion) {
    case procedure::Motion::kDefault:
      if (!step.removes.empty()) return ArrowKind::kPull;
      return step.fits.empty() ? std::nullopt : std::optional(ArrowKind::kPush);
    case procedure::Motion::kNone:
      return std::nullopt;
    case procedure::Motion::kPull:
      return ArrowKind::kPull;
    case procedure::Motion::kPush:
      return ArrowKind::kPush;
    case procedure::Motion::kTurn:
      return ArrowKind::kTurn;
    case procedure::Motion::kScrew:
      return ArrowKind::kScrew;
    case procedure::Motion::kUnscrew:
      return ArrowKind::kUnscrew;
  }
  return std::nullopt;
}

cv::Scalar scalarOf(const std::array<std::uint8_t, 3>& rgb) {
  return {double(rgb[0]), double(rgb[1]), double(rgb[2])};
}

/// Draws a shape, `more` px wider on each side.
void draw(cv::Mat& picture, const overlay::LineShape& shape, double more,
          const cv::Scalar& colour) {
  constexpr int kBits = 4;  // of a pixel's fraction
  const auto fixed = [](const glm::vec2& px) {
    // pixel centres at 0, as OpenCV has them
    return cv::Point(cvRound((px.x - 0.5F) * (1 << kBits)), cvRound((px.y - 0.5F) * (1 << kBits)));
  };
  const int width = std::max(1, cvRound(2.0 * (shape.halfWidthPx + more)));
  if (!shape.isTriangle) {
    cv::line(picture, fixed(shape.a), fixed(shape.b), colour, width, cv::LINE_AA, kBits);
    return;
  }
  const std::array corners{fixed(shape.a), fixed(shape.b), fixed(shape.c)};
  cv::fillConvexPoly(picture, corners.data(), 3, colour, cv::LINE_AA, kBits);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    cv::line(picture, corners.at(i), corners.at((i + 1) % corners.size()), colour, width,
             cv::LINE_AA, kBits);
  }
}

}  // namespace

std::vector<overlay::Arrow> arrowsOf(const Step& step, const scene::Model& machine) {
  std::vector<overlay::Arrow> arrows;
  const std::optional<ArrowKind> kind = arrowOf(step);
  if (!kind) return arrows;
  const std::vector<std::size_t>& moved = !step.removes.empty() ? step.removes
                                          : !step.fits.empty()  ? step.fits
                                                                : step.parts;
  const bool isAlong = *kind == ArrowKind::kPull || *kind == ArrowKind::kPush;
  std::vector<glm::dvec3> axes;
  for (const std::size_t part : moved) {
    if (arrows.size() == kMostArrows) break;
    const overlay::PartShape shape = overlay::alongAxis(overlay::shapeOf(machine, part), step.axis);
    const glm::dvec3 foot = shape.centre - glm::dot(shape.centre, shape.axis) * shape.axis;
    const bool isKnown = std::ranges::any_of(axes, [&](const glm::dvec3& each) {
      return glm::length(each - foot) < 0.5 * shape.radius + 1e-6;
    });
    if (isAlong && isKnown) continue;
    axes.push_back(foot);
    arrows.push_back({.kind = *kind, .part = part, .axis = step.axis});
  }
  return arrows;
}

void drawArrows(hal::Image& picture, std::span<const overlay::Arrow> arrows,
                const scene::Model& machine, const glm::dmat4& cameraFromModel,
                const tracking::CameraModel& camera, double pxScale) {
  constexpr double kCasingPx = 1.6;
  assert(picture.format().pixelFormat == hal::PixelFormat::kRgb8);
  overlay::LineShapes lines;
  for (const overlay::Arrow& each : arrows) {
    lines.addArrowOf(each, overlay::alongAxis(overlay::shapeOf(machine, each.part), each.axis),
                     cameraFromModel, camera, pxScale, 0.0);
  }
  cv::Mat pixels(picture.size().height, picture.size().width, CV_8UC3, picture.plane(0).data());
  for (const bool isCasing : {true, false}) {  // so that lines of one arrow have none between them
    for (const overlay::LineShape& shape : lines.all()) {
      draw(pixels, shape, isCasing ? kCasingPx * pxScale : 0.0,
           scalarOf(isCasing ? overlay::kCasingRgb : overlay::kReservedRgb));
    }
  }
}

void drawAxes(hal::Image& picture, const scene::Model& machine, std::size_t part,
              const glm::dmat4& cameraFromModel, const tracking::CameraModel& camera) {
  struct Axis {
    const char* name;
    glm::dvec3 direction;
    cv::Scalar colour;
  };
  static const std::array<Axis, 3> kAxes{{{"x", {1.0, 0.0, 0.0}, {214, 39, 40}},
                                          {"y", {0.0, 1.0, 0.0}, {24, 128, 40}},
                                          {"z", {0.0, 0.0, 1.0}, {31, 87, 214}}}};
  constexpr double kLeastPx = 34.0;
  const overlay::PartShape shape = overlay::shapeOf(machine, part);
  const auto seenAt = [&](const glm::dvec3& point) {
    return camera.project(glm::dvec3(cameraFromModel * glm::dvec4(point, 1.0)));
  };
  cv::Mat pixels(picture.size().height, picture.size().width, CV_8UC3, picture.plane(0).data());
  const glm::dvec2 origin = seenAt(shape.centre);
  const auto pointOf = [](const glm::dvec2& px) { return cv::Point(cvRound(px.x), cvRound(px.y)); };
  const double reach = 1.3 * std::max(shape.radius, shape.halfLength);
  const double reachPx =
      std::max({glm::distance(origin, seenAt(shape.centre + reach * shape.axis)),
                glm::distance(origin, seenAt(shape.centre + reach * shape.side)), 1e-3});
  const double longer = std::max(1.0, kLeastPx / reachPx);
  for (const bool isCasing : {true, false}) {
    for (const Axis& each : kAxes) {
      const glm::dvec3 along = overlay::alongAxis(shape, each.direction).axis;
      const glm::dvec2 end = seenAt(shape.centre + longer * reach * along);
      const cv::Scalar colour = isCasing ? cv::Scalar(255, 255, 255) : each.colour;
      cv::arrowedLine(pixels, pointOf(origin), pointOf(end), colour, isCasing ? 5 : 2, cv::LINE_AA);
      const glm::dvec2 beside = end + 9.0 * glm::normalize(end - origin + glm::dvec2(1e-6));
      cv::putText(pixels, each.name, pointOf(beside + glm::dvec2(-5.0, 4.0)),
                  cv::FONT_HERSHEY_SIMPLEX, 0.55, colour, isCasing ? 5 : 2, cv::LINE_AA);
    }
  }
}

}  // namespace pleinair::app
