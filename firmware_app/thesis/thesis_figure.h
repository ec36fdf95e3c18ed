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

/// A figure of the thesis, or its table, as this program makes it.
struct ThesisFigure {
  std::string title;         ///< "Figures 29 and 32: …"
  std::vector<int> numbers;  ///< of the thesis's figures; none for its table and §6.1
  std::string thesis;        ///< what the thesis shows, in our words
  std::string ours;          ///< what is shown here
  std::string measured;      ///< what the numbers say and how they were measured
  std::vector<ThesisPicture> pictures = {};
  std::vector<ThesisReading> readings = {};
};

}  // namespace pleinair::app
