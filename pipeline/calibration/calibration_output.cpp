#include "pipeline/calibration/calibration_output.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <glm/vec3.hpp>
#include <opencv2/imgproc.hpp>

namespace pleinair::calibration {

std::string calibrationText(const Board& board, const CalibrationReport& report) {
  assert(report.choice);
  const LensChoice& choice = *report.choice;
  const LensFit& fit = choice.fit;
  const hal::FrameSize size = fit.camera.imageSize();
  const LensVector lens = parametersOf(fit.camera);
  std::size_t corners = 0;
  for (const FitView& view : choice.used) corners += view.size();

  std::string text = "# A camera's lens, found by pleinair calibrate.\n";
  text += fmt::format("# Board: {}.\n", board.text());
  text += fmt::format("# {} views, {} corners.\n", choice.used.size(), corners);
  text += fmt::format("# Error: {:.3f} px RMS; {:.3f} px in views left out of the fit.\n",
                      fit.rmsPx, choice.heldOutRmsPx);
  text += fmt::format("# Known to {:.2f} px in most of the picture, to {:.2f} px in {}.\n",
                      report.typicalSigmaPx, report.worstSigmaPx, report.worstPlace);
  text += fmt::format("# Lens: {}. Standard deviations:\n", toString(fit.model));
  constexpr std::array<std::string_view, kLensParameters> kNames{"fx", "fy", "cx", "cy", "k1",
                                                                 "k2", "p1", "p2", "k3"};
  text += "#";
  for (std::size_t i = 0; i < kLensParameters; ++i) {
    if (fit.sigma(i) > 0.0) text += fmt::format(" {} {:.2g}", kNames.at(i), fit.sigma(i));
  }
  text += fmt::format("\nimage_size = [{}, {}]\n", size.width, size.height);
  for (std::size_t i = 0; i < 4; ++i) text += fmt::format("{} = {:.4f}\n", kNames.at(i), lens[i]);
  text += "pixel_centres = \"half\"\n";
  text += fmt::format("distortion = [{:.8g}, {:.8g}, {:.8g}, {:.8g}, {:.8g}]\n", lens[4], lens[5],
                      lens[6], lens[7], lens[8]);
  return text;
}

namespace {

constexpr double kResidualScale = 50.0;
const cv::Scalar kGood(40, 220, 90);
const cv::Scalar kBad(255, 60, 60);
const cv::Scalar kResidual(255, 190, 0);
const cv::Scalar kGrid(70, 110, 160);

/// OpenCV's fixed-point coordinates for sub-pixel drawing; they count pixel centres from 0.
constexpr int kShift = 4;
cv::Point fixedPoint(const glm::dvec2& px) {
  constexpr double kOne = 1 << kShift;
  return {static_cast<int>(std::lround((px.x - 0.5) * kOne)),
          static_cast<int>(std::lround((px.y - 0.5) * kOne))};
}

double drawingScale(hal::FrameSize size) {
  return std::max(1.0, size.width / 640.0);
}

cv::Mat matOver(hal::Image& image) {
  const hal::FrameSize size = image.size();
  return {size.height, size.width, CV_8UC3, image.plane(0).data()};
}

void drawText(cv::Mat& picture, const std::string& text, cv::Point at, double scale) {
  const double size = 0.45 * scale;
  const int width = std::max(1, static_cast<int>(std::lround(scale)));
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, size, {0, 0, 0}, 3 * width, cv::LINE_AA);
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, size, {255, 255, 255}, width,
              cv::LINE_AA);
}

void drawGrid(cv::Mat& picture) {
  for (int column = 1; column < kCellColumns; ++column) {
    const int x = picture.cols * column / kCellColumns;
    cv::line(picture, {x, 0}, {x, picture.rows}, kGrid);
  }
  for (int row = 1; row < kCellRows; ++row) {
    const int y = picture.rows * row / kCellRows;
    cv::line(picture, {0, y}, {picture.cols, y}, kGrid);
  }
}

/// Index of the view among the used ones.
std::optional<std::size_t> usedIndex(const CalibrationReport& report, std::size_t index) {
  if (!report.choice) return std::nullopt;
  const std::vector<std::size_t>& used = report.choice->usedViews;
  const auto found = std::ranges::find(used, index);
  if (found == used.end()) return std::nullopt;
  return static_cast<std::size_t>(found - used.begin());
}

}  // namespace

hal::Image viewPicture(const hal::ImageView& grey, const SelectedView& view, std::size_t index,
                       const Board& board, const CalibrationReport& report) {
  const hal::FrameSize size = grey.format.size;
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = size});
  cv::Mat picture = matOver(image);
  const cv::Mat luma(size.height, size.width, CV_8UC1,
                     const_cast<std::uint8_t*>(grey.planes[0].bytes.data()),
                     grey.planes[0].strideBytes);
  cv::cvtColor(luma, picture, cv::COLOR_GRAY2RGB);
  drawGrid(picture);
  const double scale = drawingScale(size);
  const std::optional<std::size_t> used = usedIndex(report, index);
  const int radius = static_cast<int>(std::lround(3.0 * scale * (1 << kShift)));
  for (const SightedCorner& corner : view.sighting.corners) {
    cv::circle(picture, fixedPoint(corner.px), radius, used ? kGood : kBad, 1, cv::LINE_AA, kShift);
    if (!used) continue;
    const glm::dvec3 onBoard = board.corners()[static_cast<std::size_t>(corner.id)];
    const LensFit& fit = report.choice->fit;
    const glm::dvec2 expected =
        fit.camera.project(glm::dvec3(fit.cameraFromBoard[*used] * glm::dvec4(onBoard, 1.0)));
    const glm::dvec2 end = corner.px + kResidualScale * (corner.px - expected);
    cv::line(picture, fixedPoint(corner.px), fixedPoint(end), kResidual, 1, cv::LINE_AA, kShift);
  }
  const std::string text =
      fmt::format("picture {}: edges {:.1f} px{}{}", view.frame + 1, view.sighting.edgeWidthPx,
                  used ? fmt::format(", errors x{:g}", kResidualScale) : "",
                  report.choice && !used ? ", left out: contradicts the others" : "");
  drawText(picture, text, {static_cast<int>(8 * scale), static_cast<int>(18 * scale)}, scale);
  return image;
}

hal::Image coveragePicture(const ViewSelector& selector, const CalibrationReport& report,
                           hal::FrameSize size) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = size});
  cv::Mat picture = matOver(image);
  picture.setTo(cv::Scalar(24, 26, 30));
  drawGrid(picture);
  const double scale = drawingScale(size);
  const int radius = static_cast<int>(std::lround(1.5 * scale * (1 << kShift)));
  for (std::size_t i = 0; i < selector.views().size(); ++i) {
    const bool isUsed = usedIndex(report, i).has_value();
    for (const SightedCorner& corner : selector.views()[i].sighting.corners) {
      cv::circle(picture, fixedPoint(corner.px), radius, isUsed ? kGood : kBad, cv::FILLED,
                 cv::LINE_AA, kShift);
    }
  }
  for (int row = 0; row < kCellRows; ++row) {
    for (int column = 0; column < kCellColumns; ++column) {
      const cv::Point at(picture.cols * column / kCellColumns + static_cast<int>(4 * scale),
                         picture.rows * (row + 1) / kCellRows - static_cast<int>(5 * scale));
      drawText(picture, std::to_string(report.coverage.viewsInCell(column, row)), at, scale);
    }
  }
  return image;
}

}  // namespace pleinair::calibration
