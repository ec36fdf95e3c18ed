#include "pipeline/inspection/part_window.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/tracking/image/luma.h"

namespace pleinair::inspection {
namespace {

glm::dvec3 towardCamera(const glm::dvec3& point, const glm::dmat4& cameraFromModel) {
  const glm::dvec3 eye(glm::inverse(cameraFromModel) * glm::dvec4(0.0, 0.0, 0.0, 1.0));
  return glm::normalize(eye - point);
}

/// Where each point of the window is in the picture, pixel centres at 0 as OpenCV has them.
cv::Mat mapOf(const PartWindow& window, const PosedPicture& picture) {
  constexpr float kNowhere = -1e4F;
  cv::Mat map(kWindowPx, kWindowPx, CV_32FC2, cv::Scalar(kNowhere, kNowhere));
  for (int y = 0; y < kWindowPx; ++y) {
    for (int x = 0; x < kWindowPx; ++x) {
      const double u = window.halfMetres * (2.0 * (x + 0.5) / kWindowPx - 1.0);
      const double v = window.halfMetres * (2.0 * (y + 0.5) / kWindowPx - 1.0);
      const glm::dvec3 point = window.centre + u * window.right + v * window.down;
      const glm::dvec3 seen(picture.cameraFromModel * glm::dvec4(point, 1.0));
      if (seen.z < 1e-3) continue;
      const glm::dvec2 px = picture.camera.project(seen) - 0.5;
      map.at<cv::Point2f>(y, x) = {static_cast<float>(px.x), static_cast<float>(px.y)};
    }
  }
  return map;
}

/// Smooths away what the window has no pixels for.
cv::Mat reduced(const cv::Mat& luma, double pxPerWindowPx) {
  if (pxPerWindowPx <= 1.0) return luma;
  cv::Mat smooth;
  cv::GaussianBlur(luma, smooth, {}, 0.5 * pxPerWindowPx);
  return smooth;
}

}  // namespace

PartWindow windowAbout(const glm::dvec3& centre, double radiusMetres,
                       const glm::dmat4& cameraFromModel) {
  const glm::dvec3 back = towardCamera(centre, cameraFromModel);
  const glm::dmat3 modelFromCamera = glm::transpose(glm::dmat3(cameraFromModel));
  const glm::dvec3 cameraRight = glm::normalize(modelFromCamera[0]);
  const glm::dvec3 right = glm::normalize(cameraRight - glm::dot(cameraRight, back) * back);
  return {.centre = centre,
          .right = right,
          .down = glm::cross(right, back),
          .halfMetres = radiusMetres};
}

WindowPicture windowPicture(const PartWindow& window, const PosedPicture& picture) {
  tracking::LumaFrame frame;
  frame.take(picture.image);
  const hal::PlaneView& plane = frame.luma();
  const cv::Mat luma(frame.size().height, frame.size().width, CV_8UC1,
                     const_cast<std::uint8_t*>(plane.bytes.data()),  // NOLINT(*-const-cast): read
                     plane.strideBytes);
  const cv::Mat map = mapOf(window, picture);
  const auto centre = map.at<cv::Point2f>(kWindowPx / 2, kWindowPx / 2);
  const auto edge = map.at<cv::Point2f>(kWindowPx / 2, kWindowPx - 1);
  int inside = 0;
  for (int y = 0; y < kWindowPx; ++y) {
    for (int x = 0; x < kWindowPx; ++x) {
      const auto& at = map.at<cv::Point2f>(y, x);
      const bool isInside = at.x >= 0 && at.y >= 0 && at.x <= static_cast<float>(luma.cols - 1) &&
                            at.y <= static_cast<float>(luma.rows - 1);
      inside += isInside ? 1 : 0;
    }
  }
  WindowPicture result{
      .luma = hal::Image({.pixelFormat = hal::PixelFormat::kGrey8, .size = {kWindowPx, kWindowPx}}),
      .shareInside = static_cast<double>(inside) / (kWindowPx * kWindowPx),
      .halfPx = std::hypot(edge.x - centre.x, edge.y - centre.y)};
  cv::Mat target(kWindowPx, kWindowPx, CV_8UC1, result.luma.plane(0).data());
  cv::remap(reduced(luma, 2.0 * result.halfPx / kWindowPx), target, map, {}, cv::INTER_LINEAR,
            cv::BORDER_CONSTANT, cv::Scalar(0));
  return result;
}

namespace {

/// Where an eye sees a point on the window's plane, px of the window with pixel centres at 0;
/// nothing behind the eye.
std::optional<glm::dvec2> onWindow(const PartWindow& window, const glm::dvec3& eye,
                                   const glm::dvec3& point) {
  const glm::dvec3 out = glm::cross(window.right, window.down);
  const double height = glm::dot(eye - window.centre, out);
  const double fall = glm::dot(eye - point, out);
  if (height * fall <= 0.0) return std::nullopt;
  const glm::dvec3 at = eye + height / fall * (point - eye) - window.centre;
  const glm::dvec2 share(glm::dot(at, window.right), glm::dot(at, window.down));
  return 0.5 * kWindowPx * (share / window.halfMetres + 1.0) - 0.5;
}

glm::dvec3 eyeOf(const glm::dmat4& cameraFromModel) {
  return glm::dvec3(glm::inverse(cameraFromModel)[3]);
}

/// Fills a triangle, px and height at its corners, where it is the highest.
void fillRelief(const std::array<glm::dvec3, 3>& px, std::size_t part,
                std::vector<ReliefPixel>& relief) {
  const auto& [a, b, c] = px;
  const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (area == 0.0) return;
  const auto range = [](double u, double v, double w) {
    return std::pair(std::max(0, static_cast<int>(std::floor(std::min({u, v, w})))),
                     std::min(kWindowPx - 1, static_cast<int>(std::ceil(std::max({u, v, w})))));
  };
  const auto [left, right] = range(a.x, b.x, c.x);
  const auto [top, bottom] = range(a.y, b.y, c.y);
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const double u = ((b.x - x) * (c.y - y) - (b.y - y) * (c.x - x)) / area;
      const double v = ((c.x - x) * (a.y - y) - (c.y - y) * (a.x - x)) / area;
      if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
      const auto height = static_cast<float>(u * a.z + v * b.z + (1.0 - u - v) * c.z);
      ReliefPixel& there =
          relief[static_cast<std::size_t>(y) * kWindowPx + static_cast<std::size_t>(x)];
      if (!(there.height >= height)) there = {height, static_cast<std::uint16_t>(part)};
    }
  }
}

}  // namespace

std::vector<ReliefPixel> windowRelief(const PartWindow& window, const glm::dmat4& cameraFromModel,
                                      std::span<const PartTriangle> triangles) {
  constexpr double kFarPx = 20.0 * kWindowPx;
  std::vector<ReliefPixel> relief(static_cast<std::size_t>(kWindowPx) * kWindowPx);
  const glm::dvec3 out = -glm::cross(window.right, window.down);
  const glm::dvec3 eye = eyeOf(cameraFromModel);
  for (const PartTriangle& triangle : triangles) {
    std::array<glm::dvec3, 3> px{};  // and how far it stands out
    bool isSeen = true;
    for (std::size_t i = 0; i < px.size() && isSeen; ++i) {
      const auto at = onWindow(window, eye, triangle.corners.at(i));
      isSeen = at && glm::length(*at) < kFarPx;
      if (!isSeen) break;
      px.at(i) = {*at, glm::dot(triangle.corners.at(i) - window.centre, out) / window.halfMetres};
    }
    if (isSeen) fillRelief(px, triangle.part, relief);
  }
  return relief;
}

glm::dvec2 reliefShiftPx(const PartWindow& window, const glm::dmat4& cameraFromModel,
                         const glm::dmat4& otherFromModel) {
  // Along the first camera's line of sight, so that the place in the first picture is the centre's.
  const glm::dvec3 point =
      window.centre + window.halfMetres * towardCamera(window.centre, cameraFromModel);
  const auto there = onWindow(window, eyeOf(otherFromModel), point);
  return there ? *there - 0.5 * (kWindowPx - 1.0) : glm::dvec2(0.0);
}

double viewAngleRad(const glm::dvec3& point, const glm::dmat4& cameraFromModel,
                    const glm::dmat4& otherFromModel) {
  const double cosine =
      glm::dot(towardCamera(point, cameraFromModel), towardCamera(point, otherFromModel));
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

}  // namespace pleinair::inspection
