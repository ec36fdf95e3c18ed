#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/image.h"

namespace pleinair::measure {

/// Strokes of PainterlyParameters, for a comparison on equal terms. Widths in px.
struct StraightStrokeOptions {
  int layers = 4;
  double finestPixels = 4.0;
  double layerRatio = 2.0;
  double length = 8.0;     ///< in widths, at most
  double sigmaPx = 8.0;    ///< of the radial-basis field (eq. 12)
  double edgePart = 0.25;  ///< of the strongest edges, from which a stroke is clipped
  std::uint64_t seed = 1;
};

struct StraightStrokePainting {
  hal::Image picture;  ///< RGB8
  std::size_t strokes = 0;
  double fieldMs = 0.0;  ///< of the interpolation, on one core
  double drawMs = 0.0;
};

/// A still picture painted as Hays and Essa do (Image and Video Based Painterly Animation, NPAR
/// 2004), as far as it can be had from their paper: layers of straight strokes of one segment at
/// jittered grid points, which follow a global radial-basis interpolation of the strongest
/// gradients and are clipped at edges; finer layers only where there is detail. Without their
/// scanned brush textures, which are not published, and without their motion by optical flow: a
/// baseline for single pictures (thesis figures 24 and 25). `image`: RGB8. One core; the same for
/// the same seed.
StraightStrokePainting paintWithStraightStrokes(const hal::Image& image,
                                                const StraightStrokeOptions& options = {});

}  // namespace pleinair::measure
