#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <utility>
#include <vector>

#include "config/parameter_values.h"
#include "hal/pixel_format.h"

namespace pleinair::styles {

using ParameterList = std::initializer_list<std::pair<const char*, const char*>>;

/// Broad strokes that go astray, and nothing that could be taken for a spill; then `more`.
inline config::ParameterValues spilling(config::ParameterValues values, ParameterList more) {
  for (const ParameterList& each :
       {ParameterList{{"stroke_size", "10"},
                      {"wash", "0"},
                      {"ground_red", "0"},
                      {"ground_green", "0"},
                      {"ground_blue", "0"},
                      {"canvas", "0"},
                      {"relief", "0"},
                      {"gloss", "0"},
                      {"saturation", "1"},
                      {"warmth", "0"},
                      {"hue_jitter", "0"},
                      {"saturation_jitter", "0"},
                      {"value_jitter", "0"},
                      {"wander", "1"},
                      {"accents", "false"},  // or they would lean away from it
                      {"colour_clip", "0"},
                      {"colour_threshold", "1"},
                      {"detail", "0.01"}},
        more}) {
    for (const auto& [name, value] : each) values = values.with(name, value);
  }
  return values;
}

/// How many pixels of a red shape on blue, two away from its outline at least, have the other
/// side's colour. `beyond`: how far a pixel is outside, px.
inline int spilledPixels(const std::vector<std::uint8_t>& painted, hal::FrameSize size,
                         const std::function<double(int, int)>& beyond) {
  int count = 0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto* p = &painted[static_cast<std::size_t>(y * size.width + x) * 4];
      if (beyond(x, y) < -2.0 && p[2] > p[0] + 20) ++count;
      if (beyond(x, y) > 2.0 && p[0] > p[2] + 20) ++count;
    }
  }
  return count;
}

}  // namespace pleinair::styles
