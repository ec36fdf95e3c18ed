#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/measure/mean.h"

namespace pleinair::measure {

// A mask of movers, the things that move before a camera, is 255 on them, else 0.

/// How much a pixel differs in the channel that differs most, in levels.
int largestDifference(const cv::Vec3b& a, const cv::Vec3b& b);
/// The mean over the three channels, in levels.
double meanDifference(const cv::Vec3b& a, const cv::Vec3b& b);

/// Pixels that differ from the ground by more than this, in levels, are clearly a mover's.
inline constexpr int kContrastLevels = 30;

/// Finds movers before a standing camera: areas that differ from the median of up to 41 of the
/// frames, without specks. Precondition: there is a frame, and all have one size.
std::vector<cv::Mat1b> findMovers(const std::vector<cv::Mat3b>& inputs);

/// The masked area and what is within `radius` px of it.
cv::Mat1b grown(const cv::Mat1b& mask, int radius);
/// The masked area without what is within `radius` px of its border.
cv::Mat1b eroded(const cv::Mat1b& mask, int radius);

/// The distance by which displaced() moves a mask to the right and down.
inline constexpr int kDisplacementPixels = 20;
/// A mask that misses its mover: the negative control of masks.
cv::Mat1b displaced(const cv::Mat1b& mask);

/// The masked share of the pixels within the frame's border.
Mean shareWithinBorder(const cv::Mat1b& mask);

/// A mover changes nothing beyond this distance.
inline constexpr int kFarPixels = 16;

/// The parts of a frame around its movers.
struct MoverZones {
  explicit MoverZones(const cv::Mat1b& movers);

  cv::Mat1b mover;
  cv::Mat1b within;  ///< the mover without 2 px along its border: surely the mover
  cv::Mat1b close;   ///< the mover and 3 px around it: a place outside counts as left
  cv::Mat1b near;    ///< the mover and 12 px around it: a place outside shows the ground
  cv::Mat1b far;     ///< the mover and kFarPixels around it
};

}  // namespace pleinair::measure
