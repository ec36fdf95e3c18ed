#include "firmware_app/overlay/step_movie.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "firmware_app/overlay/card.h"
#include "hal/cameras/recording/movie_frames.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;

constexpr hal::Duration kPeriod = 80ms;
constexpr double kMostFrames = procedure::kMostMovie / kPeriod + 1;

/// `place`, but no larger than all frames of the longest movie may be.
hal::FrameSize frameSize(hal::FrameSize place) {
  constexpr double kMostPixels = kMostMovieBytes / 3.0 / kMostFrames;
  const double share = std::min(1.0, std::sqrt(kMostPixels / place.width / place.height));
  return {std::max(1, static_cast<int>(share * place.width)),
          std::max(1, static_cast<int>(share * place.height))};
}

cv::Mat matOf(hal::Image& rgb) {
  return {rgb.size().height, rgb.size().width, CV_8UC3, rgb.plane(0).data()};
}

/// A white triangle on a dark disc in the middle.
void drawPlaySign(hal::Image& rgb) {
  cv::Mat picture = matOf(rgb);
  const cv::Point middle(picture.cols / 2, picture.rows / 2);
  const int radius = std::max(4, std::min(picture.cols, picture.rows) / 5);
  cv::circle(picture, middle, radius, {20, 20, 20}, cv::FILLED, cv::LINE_AA);
  cv::circle(picture, middle, radius, {255, 255, 255}, std::max(1, radius / 8), cv::LINE_AA);
  const int side = radius / 2;
  const std::vector<cv::Point> triangle{{middle.x - side * 2 / 3, middle.y - side},
                                        {middle.x + side, middle.y},
                                        {middle.x - side * 2 / 3, middle.y + side}};
  cv::fillConvexPoly(picture, triangle, {255, 255, 255}, cv::LINE_AA);
}

}  // namespace

hal::FrameSize sizeOfRows(hal::FrameSize picture, int rows, int mostColumns) {
  const std::int64_t width = std::max(1, picture.width);
  const std::int64_t height = std::max(1, picture.height);
  const std::int64_t columns = width * rows / height;
  if (columns > mostColumns) {
    return {std::max(1, mostColumns), std::max(1, static_cast<int>(height * mostColumns / width))};
  }
  return {std::max(1, static_cast<int>(columns)), std::max(1, rows)};
}

hal::Image scaledRgb(const hal::ImageView& rgb, hal::FrameSize size) {
  const hal::PlaneView& plane = rgb.planes[0];
  const cv::Mat from(rgb.format.size.height, rgb.format.size.width, CV_8UC3,
                     const_cast<std::uint8_t*>(plane.bytes.data()), plane.strideBytes);
  hal::Image scaled({.pixelFormat = hal::PixelFormat::kRgb8, .size = size});
  cv::Mat to = matOf(scaled);
  cv::resize(from, to, to.size(), 0.0, 0.0, cv::INTER_AREA);
  return scaled;
}

hal::Result<std::shared_ptr<const overlay::PanelMovie>> readStepMovie(
    const std::filesystem::path& file, hal::FrameSize place, const std::stop_token& stop) {
  const hal::FrameSize size = frameSize(place);
  auto movie = std::make_shared<overlay::PanelMovie>();
  hal::Duration due{0};
  hal::Duration last{0};
  int count = 0;
  const auto take = [&](const hal::ImageView& rgb, hal::Duration time) {
    // A longer one is another file than was checked.
    if (time >= procedure::kMostMovie) return false;
    last = time;
    ++count;
    if (time < due) return true;
    movie->frames.push_back({.begins = time, .image = scaledRgb(rgb, size)});
    // The frame nearest to each multiple of the period, of movies of any rate.
    due = std::max(due, time - kPeriod / 2) + kPeriod;
    return true;
  };
  const auto read = hal::forMovieFrames(file, {}, take, [&] { return stop.stop_requested(); });
  if (stop.stop_requested()) return nullptr;
  if (!read) return tl::unexpected(read.error());
  // The last frame lasts as long as the others.
  movie->length = last + (count > 1 ? std::max<hal::Duration>(last / (count - 1), 1ms) : kPeriod);
  return movie;
}

std::shared_ptr<const overlay::PanelMovie> textMovie(const std::string& text,
                                                     hal::FrameSize place) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = place});
  const int fontPixels = std::clamp(place.height / 6, 8, 40);
  const hal::Image ink = inkOfText(text, fontPixels, place.width);
  const int left = std::max(0, (place.width - ink.size().width) / 2);
  const int top = std::max(0, (place.height - ink.size().height) / 2);
  for (int y = 0; y < std::min(ink.size().height, place.height - top); ++y) {
    const auto from = ink.view().row(0, y);
    auto to = image.row(0, top + y).subspan(3 * static_cast<std::size_t>(left));
    for (int x = 0; x < std::min(ink.size().width, place.width - left); ++x) {
      std::fill_n(to.begin() + 3 * x, 3, from[static_cast<std::size_t>(x)]);
    }
  }
  auto movie = std::make_shared<overlay::PanelMovie>();
  movie->frames.push_back({.begins = 0ms, .image = std::move(image)});
  movie->length = 1s;
  return movie;
}

std::optional<hal::Image> moviePoster(const std::filesystem::path& file, int rows) {
  std::optional<hal::Image> poster;
  const auto read = hal::forMovieFrames(file, {}, [&](const hal::ImageView& rgb, hal::Duration) {
    poster = scaledRgb(rgb, sizeOfRows(rgb.format.size, rows));
    return false;
  });
  if (!read || !poster) return std::nullopt;
  drawPlaySign(*poster);
  return poster;
}

}  // namespace pleinair::app
