#pragma once

namespace pleinair::scene {

/// How surfaces are shaded; a style asks for one.
enum class Shading {
  kToon = 0,   ///< three bands (thesis §3.2.2), whose edges are clean
  kSmooth = 1  ///< as a camera would see them
};

}  // namespace pleinair::scene
