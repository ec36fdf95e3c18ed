#pragma once

#include "pipeline/scene/models/model.h"

namespace pleinair::scene {

// Small models that deform, for trials and reports: what thesis chapter V shows with a running
// figure, without a file. Both have spiral bands of two colours, so that strokes on them can be
// told apart.

/// A tube that stands on z = 0 and sways: a skin over a chain of joints, with the clip "sway".
struct TubeParameters {
  double lengthMetres = 0.25;  ///< upright; it is 0.3 of that thick
  friend bool operator==(const TubeParameters&, const TubeParameters&) = default;
};
Model tubeModel(const TubeParameters& parameters);

/// A ball that lies on z = 0 and changes its shape: two morph targets (lobes, and a squeeze), with
/// the clip "change".
struct BallParameters {
  double diameterMetres = 0.2;  ///< at rest
  friend bool operator==(const BallParameters&, const BallParameters&) = default;
};
Model ballModel(const BallParameters& parameters);

}  // namespace pleinair::scene
