#include "firmware_app/thesis/thesis_drawing.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "firmware_app/thesis/thesis_page.h"

namespace pleinair::app {
namespace {

constexpr int kGap = 6;
const cv::Vec3b kWhite(255, 255, 255);

}  // namespace

cv::Mat3b inRow(const std::vector<cv::Mat3b>& pictures) {
  int width = -kGap;
  for (const cv::Mat3b& each : pictures) width += each.cols + kGap;
  cv::Mat3b sheet(pictures.front().rows, width, kWhite);
  int left = 0;
  for (const cv::Mat3b& each : pictures) {
    each.copyTo(sheet(cv::Rect(left, 0, each.cols, each.rows)));
    left += each.cols + kGap;
  }
  return sheet;
}

cv::Mat3b inColumn(const std::vector<cv::Mat3b>& pictures) {
  int height = -kGap;
  for (const cv::Mat3b& each : pictures) height += each.rows + kGap;
  cv::Mat3b sheet(height, pictures.front().cols, kWhite);
  int top = 0;
  for (const cv::Mat3b& each : pictures) {
    each.copyTo(sheet(cv::Rect(0, top, each.cols, each.rows)));
    top += each.rows + kGap;
  }
  return sheet;
}

cv::Mat3b enlarged(const cv::Mat3b& picture, const cv::Rect& part, int factor) {
  cv::Mat3b large;
  cv::resize(picture(part), large, {}, factor, factor, cv::INTER_NEAREST);
  return large;
}

cv::Mat3b atLeast(const cv::Mat3b& picture, int width) {
  const int factor = std::max(1, (width + picture.cols / 2) / picture.cols);
  return enlarged(picture, cv::Rect(cv::Point(), picture.size()), factor);
}

cv::Mat3b pale(const cv::Mat3b& picture) {
  cv::Mat3b paler;
  picture.convertTo(paler, CV_8UC3, 0.4, 150.0);
  return paler;
}

void addDot(cv::Mat3b& picture, cv::Point2d px, const cv::Scalar& colour) {
  const cv::Point at(static_cast<int>(std::floor(px.x)), static_cast<int>(std::floor(px.y)));
  const cv::Rect frame(cv::Point(), picture.size());
  for (const cv::Point step : {cv::Point(0, 0), {1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    if (!frame.contains(at + step)) continue;
    picture(at + step) =
        cv::Vec3b(static_cast<std::uint8_t>(colour[0]), static_cast<std::uint8_t>(colour[1]),
                  static_cast<std::uint8_t>(colour[2]));
  }
}

cv::Rect partAround(const cv::Mat1b& mask, cv::Size size) {
  cv::Point middle(mask.cols / 2, mask.rows / 2);
  const cv::Moments moments = cv::moments(mask, true);
  if (moments.m00 > 0.0) {
    middle = {static_cast<int>(moments.m10 / moments.m00),
              static_cast<int>(moments.m01 / moments.m00)};
  }
  size.width = std::min(size.width, mask.cols);
  size.height = std::min(size.height, mask.rows);
  const int left = std::clamp(middle.x - size.width / 2, 0, mask.cols - size.width);
  const int top = std::clamp(middle.y - size.height / 2, 0, mask.rows - size.height);
  return {cv::Point(left, top), size};
}

cv::Mat3b bars(const std::vector<std::pair<std::string, double>>& values, const std::string& unit) {
  constexpr int kRow = 30;
  constexpr int kText = 260;
  constexpr int kLongest = 420;
  constexpr int kWidth = kText + kLongest + 130;
  double most = 0.0;
  for (const auto& [text, value] : values) most = std::max(most, value);
  cv::Mat3b chart(kRow * static_cast<int>(values.size()) + 12, kWidth, kWhite);
  const cv::Scalar ink(34, 38, 43);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto& [text, value] = values[i];
    const int top = 6 + kRow * static_cast<int>(i);
    const int length =
        std::max(1, static_cast<int>(std::lround(kLongest * value / std::max(most, 1e-12))));
    cv::putText(chart, text, {6, top + 20}, cv::FONT_HERSHEY_SIMPLEX, 0.5, ink, 1, cv::LINE_AA);
    cv::rectangle(chart, cv::Rect(kText, top + 5, length, kRow - 10), cv::Scalar(156, 60, 38),
                  cv::FILLED);
    cv::putText(chart, fmt::format("{} {}", readingText(value), unit),
                {kText + length + 8, top + 20}, cv::FONT_HERSHEY_SIMPLEX, 0.5, ink, 1, cv::LINE_AA);
  }
  return chart;
}

}  // namespace pleinair::app
