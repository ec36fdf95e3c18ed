#pragma once

#include <cstdint>

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>

namespace pleinair::marks {

/// What an anchor's last motion was taken from: of all that knew, the one with the smallest
/// predicted error.
enum class MotionSource : std::uint32_t {
  kUnknown = 0,   ///< nothing knew: it has stayed where it was
  kSurface = 1,   ///< the surface it lives on (scene::SurfaceMotionSource has the same first ones)
  kPlane = 2,     ///< a plane of the scene
  kPicture = 3,   ///< the homography that most of the picture follows
  kFeatures = 4,  ///< the triangle of the nearest features (thesis §4.3.3)
  kFlow = 5,      ///< dense optical flow
  kStill = 6,     ///< the picture does not move there
};

/// The point that a mark belongs to, as it lies in its slot on the GPU (shaders/anchor.glsl). All
/// px are of the full picture (scene::ArFrame::full()), whatever the level of quality.
struct Anchor {
  glm::vec2 px{0.0F};
  glm::vec2 displacementPx{0.0F};  ///< since the frame before
  glm::mat2 jacobian{1.0F};        ///< of px by the px before: turns and scales what hangs on it
  /// Of the first two corners of the triangle it lives on; in the image: what it looks like there
  /// (shaders/anchor_appearance.glsl).
  glm::vec2 barycentrics{0.0F};
  float errorPx = 0.0F;  ///< predicted, of the displacement
  float fade = 0.0F;     ///< how much of its mark is seen, in [0, 1]
  float ageSeconds = 0.0F;
  std::uint32_t seed = 0;     ///< of all that is random about it, as long as it lives
  std::uint32_t surface = 0;  ///< the object and triangle it lives on (ArFrame::ids); 0: the image
  std::uint32_t state = 0;    ///< a MotionSource, and the flags below

  static constexpr std::uint32_t kSourceBits = 0xFF;
  static constexpr std::uint32_t kAlive = 0x100;   ///< else the slot is free, and says nothing
  static constexpr std::uint32_t kDying = 0x200;   ///< fading out for good: there were too many
  static constexpr std::uint32_t kHidden = 0x400;  ///< fading out: what it lives on is not seen
  static constexpr std::uint32_t kBorn = 0x800;    ///< in this frame

  bool isAlive() const { return (state & kAlive) != 0; }
  bool isBorn() const { return (state & kBorn) != 0; }
  /// Whether it is not on its way out.
  bool isStaying() const { return (state & (kAlive | kDying | kHidden)) == kAlive; }
  MotionSource source() const { return static_cast<MotionSource>(state & kSourceBits); }
};
static_assert(sizeof(Anchor) == 64);

}  // namespace pleinair::marks
