#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace pleinair::app {

/// A number beside a figure.
struct ThesisReading {
  std::string key;   ///< in JSON: "slip_px"
  std::string text;  ///< for people: "slip of marks a frame, 95 %"
  double value = 0.0;
  std::string unit;  ///< "px"; may be empty
};

struct ThesisPicture {
  std::string caption;
  cv::Mat3b image;  ///< RGB
};

/// What is made for a figure of the thesis.
struct ThesisFigure {
  std::vector<ThesisPicture> pictures = {};
  std::vector<ThesisReading> readings = {};
  std::string measured = {};  ///< what the numbers say and how they were measured
};

}  // namespace pleinair::app
