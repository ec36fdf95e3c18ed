#pragma once

#include <cstdint>

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>

namespace pleinair::marks {

/// The source of an anchor's last motion: the available source with the smallest predicted error.
enum class MotionSource : std::uint32_t {
  kUnknown = 0,  ///< no source was available: the anchor stayed in place
  /// the surface that it lies on (scene::SurfaceMotionSource begins with the same values)
  kSurface = 1,
  kPlane = 2,     ///< a plane of the scene
  kPicture = 3,   ///< the homography that most of the image follows
  kFeatures = 4,  ///< the triangle of the nearest features (thesis §4.3.3)
  kFlow = 5,      ///< dense optical flow
  kStill = 6,     ///< the image is static there
};

/// The point that a mark belongs to, as stored in its slot on the GPU (shaders/anchor.glsl). All px
/// are those of the full image (scene::ArFrame::full()), at every quality level.
struct Anchor {
  glm::vec2 px{0.0F};
  glm::vec2 displacementPx{0.0F};  ///< since the previous frame
  /// of the position by the previous position; rotates and scales the mark
  glm::mat2 jacobian{1.0F};
  /// With kOnSurface: coordinates of the first two corners of its triangle, 16-bit unorms, the
  /// first in the lower half (as in ArFrame::barycentrics).
  std::uint32_t barycentrics = 0;
  /// in the camera image: the colour of its surroundings (shaders/anchor_appearance.glsl)
  std::uint32_t appearance = 0;
  float errorPx = 0.0F;  ///< predicted error of the displacement
  float fade = 0.0F;     ///< visible share of its mark, in [0, 1]
  /// lower half: its age in 1/1024 s, at most 64 s; upper half: its rank
  std::uint32_t ageAndRank = 0;
  std::uint32_t seed = 0;  ///< seeds all its random properties, for its whole life
  /// The object and triangle that it lies on (ArFrame::ids), a virtual or a real one; 0: a part of
  /// the image without a model. The triangle only with kOnSurface.
  std::uint32_t surface = 0;
  /// a MotionSource, the flags below, its mover's number less 1 (0x30), and in the upper 16 bits
  /// for how long a mover has covered it (shaders/anchor.glsl)
  std::uint32_t state = 0;

  static constexpr std::uint32_t kSourceBits = 0x0F;
  /// not alive, but its place on a virtual surface is remembered, so that the same mark can be seen
  /// again; with kHidden, that place is not seen now
  static constexpr std::uint32_t kDormant = 0x80;
  /// without this flag, the slot has no mark
  static constexpr std::uint32_t kAlive = 0x100;
  static constexpr std::uint32_t kDying = 0x200;  ///< fading out for good: its cell was too crowded
  static constexpr std::uint32_t kHidden = 0x400;  ///< fading out: its surface is occluded
  static constexpr std::uint32_t kBorn = 0x800;    ///< spawned in this frame
  /// a mover covers it: its mark keeps its slot (AnchorHold::memory) and stays as it is, and is
  /// clipped where the mover is seen
  static constexpr std::uint32_t kCovered = 0x1000;
  static constexpr std::uint32_t kMover = 0x2000;  ///< on a mover (MotionLayers)
  /// its triangle and barycentrics are known: the surface carries it
  static constexpr std::uint32_t kOnSurface = 0x4000;

  bool isAlive() const { return (state & kAlive) != 0; }
  bool isDormant() const { return (state & (kAlive | kDormant)) == kDormant; }
  float ageSeconds() const { return static_cast<float>(ageAndRank & 0xFFFFU) / 1024.0F; }
  /// Which anchors go first where there are too many: those of the highest rank, which is kept for
  /// life. It is the scale from which on the anchor is needed, in 1/1024 octaves of px per metre
  /// on virtual surfaces, of the image's length elsewhere.
  std::uint32_t rank() const { return ageAndRank >> 16U; }
  bool isCovered() const { return (state & (kAlive | kCovered)) == (kAlive | kCovered); }
  bool isOnSurface() const { return (state & (kAlive | kOnSurface)) == (kAlive | kOnSurface); }
  bool isBorn() const { return (state & kBorn) != 0; }
  /// Whether the anchor is alive, not fading out and not covered.
  bool isStaying() const { return (state & (kAlive | kDying | kHidden | kCovered)) == kAlive; }
  MotionSource source() const { return static_cast<MotionSource>(state & kSourceBits); }
};
static_assert(sizeof(Anchor) == 64);

}  // namespace pleinair::marks
