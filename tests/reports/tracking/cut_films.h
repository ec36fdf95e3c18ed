#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "hal/cameras/synthetic/render/shot.h"

namespace pleinair::tracking {

/// The luma of a film's frames, kFilmSize each.
using Film = std::vector<cv::Mat>;
inline const cv::Size kFilmSize{640, 480};

/// Every n-th frame of a recording, from `first` on, cut to the size; empty where there is no such
/// file or it has fewer frames.
Film recording(const std::string& path, std::size_t first, std::size_t count,
               std::size_t every = 1);
/// The same of a shot of the synthetic camera.
Film workbench(hal::SyntheticShot shot, std::size_t first, std::size_t count,
               std::size_t every = 1);
/// A photograph of the shared data; empty where it is missing.
cv::Mat photo(const std::string& name);

/// A square part of an image's sides, enlarged to the whole; x and y in parts of the sides.
cv::Mat crop(const cv::Mat& image, double x, double y, double part);
/// An image with sensor noise of two levels.
cv::Mat noisy(const cv::Mat& image, unsigned seed);
/// A camera that pans by `stepPx` a frame over an image enlarged to twice the size, blurred along
/// its motion or not.
Film panOver(const cv::Mat& image, int stepPx, bool blurs);

}  // namespace pleinair::tracking
