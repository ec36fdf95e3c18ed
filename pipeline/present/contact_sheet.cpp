#include "pipeline/present/contact_sheet.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace pleinair::present {
namespace {

constexpr int kTileWidthPx = 480;
constexpr int kGapPx = 6;
constexpr int kPairsPerRow = 2;
constexpr int kTallestTilePx = 960;

/// A borrowed view; OpenCV has no read-only Mat, but nothing writes through it.
cv::Mat matOf(const hal::ImageView& image) {
  assert(image.format.pixelFormat == hal::PixelFormat::kRgb8);
  return {image.format.size.height, image.format.size.width, CV_8UC3,
          const_cast<std::uint8_t*>(image.planes[0].bytes.data()), image.planes[0].strideBytes};
}

cv::Mat matOf(hal::Image& image) {
  return {image.size().height, image.size().width, CV_8UC3, image.plane(0).data()};
}

hal::FrameSize tileSize(hal::FrameSize picture) {
  const double scale = std::min({1.0, static_cast<double>(kTileWidthPx) / picture.width,
                                 static_cast<double>(kTallestTilePx) / picture.height});
  return {std::max(1, static_cast<int>(std::lround(picture.width * scale))),
          std::max(1, static_cast<int>(std::lround(picture.height * scale)))};
}

hal::Image tile(const hal::ImageView& picture) {
  hal::Image result(
      {.pixelFormat = hal::PixelFormat::kRgb8, .size = tileSize(picture.format.size)});
  cv::Mat target = matOf(result);
  cv::resize(matOf(picture), target, target.size(), 0, 0, cv::INTER_AREA);
  return result;
}

void place(cv::Mat& sheet, const hal::Image& picture, int column, int row) {
  const hal::FrameSize size = picture.size();
  const cv::Rect where(kGapPx + column * (size.width + kGapPx),
                       kGapPx + row * (size.height + kGapPx), size.width, size.height);
  matOf(picture.view()).copyTo(sheet(where));
}

/// More are held than are shown, since those that are shown are to be evenly spaced.
constexpr std::size_t kKeptPerMoment = 4;

void label(cv::Mat& sheet, const std::string& text, hal::FrameSize tile, int column, int row) {
  const cv::Point at(kGapPx + column * (tile.width + kGapPx) + 8,
                     kGapPx + row * (tile.height + kGapPx) + 20);
  cv::putText(sheet, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.5, {0, 0, 0}, 3, cv::LINE_AA);
  cv::putText(sheet, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.5, {255, 255, 255}, 1, cv::LINE_AA);
}

}  // namespace

ContactSheet::ContactSheet(int moments) : wanted_(static_cast<std::size_t>(moments)) {
  assert(moments >= 1);
}

void ContactSheet::add(const hal::ImageView& original, const hal::ImageView& painted,
                       hal::Duration time) {
  moments_.push_back({tile(original), tile(painted), time});
  const std::size_t kept = kKeptPerMoment * wanted_;
  if (moments_.size() < 2 * kept) return;
  // Keep every second one, and take half as many from now on.
  for (std::size_t i = 1; i < kept; ++i) moments_[i] = std::move(moments_[2 * i]);
  moments_.resize(kept);
  stride_ *= 2;
}

std::vector<const ContactSheet::Moment*> ContactSheet::chosen() const {
  const std::size_t count = std::min(wanted_, moments_.size());
  std::vector<const Moment*> result;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t last = moments_.size() - 1;
    result.push_back(&moments_[count == 1 ? 0 : (i * last + (count - 1) / 2) / (count - 1)]);
  }
  return result;
}

hal::Image ContactSheet::sheet() const {
  const std::vector<const Moment*> pairs = chosen();
  assert(!pairs.empty());
  const hal::FrameSize tile = pairs.front()->original.size();
  const int count = static_cast<int>(pairs.size());
  const int columns = 2 * std::min(count, kPairsPerRow);
  const int rows = (count + kPairsPerRow - 1) / kPairsPerRow;
  hal::Image image(
      {.pixelFormat = hal::PixelFormat::kRgb8,
       .size = {kGapPx + columns * (tile.width + kGapPx), kGapPx + rows * (tile.height + kGapPx)}});
  std::ranges::fill(image.plane(0), std::uint8_t{255});
  cv::Mat sheet = matOf(image);
  for (int i = 0; i < count; ++i) {
    const Moment& moment = *pairs[static_cast<std::size_t>(i)];
    const int column = 2 * (i % kPairsPerRow);
    const int row = i / kPairsPerRow;
    place(sheet, moment.original, column, row);
    place(sheet, moment.painted, column + 1, row);
    const double seconds = hal::toSeconds(moment.time);
    if (tile.width >= 100) label(sheet, fmt::format("{:.2f} s", seconds), tile, column, row);
  }
  return image;
}

}  // namespace pleinair::present
