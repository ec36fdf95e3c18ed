#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/measure/input/true_motion.h"

namespace pleinair::measure {

/// Every point moves by `perFrame` px from each frame to the next.
std::unique_ptr<TrueMotion> constantMotion(cv::Size frame, cv::Point2d perFrame);

/// `frameFromFirst(t)` maps pixels of frame 0 to frame t (pixel centres at whole numbers), in
/// homogeneous coordinates.
std::unique_ptr<TrueMotion> homographyMotion(
    cv::Size frame, std::string description,
    std::function<cv::Matx33d(std::uint64_t)> frameFromFirst);

}  // namespace pleinair::measure
