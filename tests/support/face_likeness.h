#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "hal/pixel_format.h"
#include "tests/support/drawn_face.h"

namespace pleinair::support {

/// Luma, row by row.
using GreyPicture = std::vector<double>;

template <class Bytes>
GreyPicture greyOf(const Bytes& rgba) {
  GreyPicture grey(rgba.size() / 4);
  for (std::size_t i = 0; i < grey.size(); ++i) {
    grey[i] = 0.299 * rgba[4 * i] + 0.587 * rgba[4 * i + 1] + 0.114 * rgba[4 * i + 2];
  }
  return grey;
}

inline double meanAround(const GreyPicture& grey, hal::FrameSize size, int x, int y, int radius) {
  double sum = 0.0;
  for (int dy = -radius; dy <= radius; ++dy) {
    for (int dx = -radius; dx <= radius; ++dx) {
      sum += grey[static_cast<std::size_t>((y + dy) * size.width + x + dx)];
    }
  }
  return sum / ((2 * radius + 1) * (2 * radius + 1));
}

/// The correlation of two pictures within a face, of what is larger than 3 px and smaller than 9.
inline double likeness(const GreyPicture& a, const GreyPicture& b, hal::FrameSize size,
                       const DrawnFace& drawn) {
  const auto radius = static_cast<int>(0.33 * drawn.side);  // without hair
  double ab = 0.0;
  double aa = 0.0;
  double bb = 0.0;
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      const auto featureOf = [&](const GreyPicture& grey) {
        const int atX = static_cast<int>(drawn.centre.x) + x;
        const int atY = static_cast<int>(drawn.centre.y) + y;
        return meanAround(grey, size, atX, atY, 1) - meanAround(grey, size, atX, atY, 4);
      };
      ab += featureOf(a) * featureOf(b);
      aa += featureOf(a) * featureOf(a);
      bb += featureOf(b) * featureOf(b);
    }
  }
  return ab / std::sqrt(aa * bb);
}

}  // namespace pleinair::support
