#include "firmware_app/procedure/step_close_up.h"

#include <algorithm>
#include <array>
#include <cassert>

#include <glm/geometric.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace pleinair::app {
namespace {

const cv::Scalar kLine(60, 60, 60);

cv::Mat3b pixelsOf(hal::Image& image) {
  return {image.size().height, image.size().width,
          reinterpret_cast<cv::Vec3b*>(image.plane(0).data())};
}

cv::Point pointOf(const glm::dvec2& px) {
  return {cvRound(px.x), cvRound(px.y)};
}

}  // namespace

void setCloseUp(hal::Image& picture, const hal::Image& closeUp, const glm::dvec2& placePx,
                double radiusPx, const glm::dvec2& away) {
  assert(picture.size() == closeUp.size());
  const glm::dvec2 size(picture.size().width, picture.size().height);
  const double radius = 0.5 * kCloseUpShare * size.y;
  const double inset = radius + 0.03 * size.y;
  const std::array<glm::dvec2, 4> corners{glm::dvec2(inset), glm::dvec2(size.x - inset, inset),
                                          glm::dvec2(inset, size.y - inset), size - inset};
  const glm::dvec2 centre = *std::ranges::max_element(
      corners, {}, [&](const glm::dvec2& each) { return glm::distance(each, away); });
  cv::Mat3b pixels = pixelsOf(picture);
  const int width = std::max(1, cvRound(size.x / 320.0));
  const glm::dvec2 way = glm::normalize(centre - placePx);
  cv::circle(pixels, pointOf(placePx), cvRound(radiusPx), kLine, width, cv::LINE_AA);
  cv::line(pixels, pointOf(placePx + radiusPx * way), pointOf(centre - radius * way), kLine, width,
           cv::LINE_AA);
  const hal::ImageView near = closeUp.view();
  for (int y = 0; y < pixels.rows; ++y) {
    const auto from =
        near.row(0, y + cvRound(0.5 * size.y - centre.y) < 0
                        ? 0
                        : std::min(y + cvRound(0.5 * size.y - centre.y), pixels.rows - 1));
    for (int x = 0; x < pixels.cols; ++x) {
      if (glm::distance(glm::dvec2(x, y), centre) > radius) continue;
      const int u = std::clamp(x + cvRound(0.5 * size.x - centre.x), 0, pixels.cols - 1);
      const auto at = 3 * static_cast<std::size_t>(u);
      pixels(y, x) = cv::Vec3b(from[at], from[at + 1], from[at + 2]);
    }
  }
  cv::circle(pixels, pointOf(centre), cvRound(radius), kLine, 2 * width, cv::LINE_AA);
}

}  // namespace pleinair::app
