#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/mat4x4.hpp>

namespace pleinair::hal::synthetic {

/// A rigid body of the scene. The room stands; each other body moves by itself.
using Body = std::uint8_t;

inline constexpr Body kRoom = 0;
inline constexpr Body kArm = 1;
inline constexpr Body kFirstOfFigures = 2;  ///< the figures' parts follow one another: bodyOf()
inline constexpr std::size_t kFigures = 2;
inline constexpr std::size_t kPartsPerFigure = 12;
inline constexpr std::size_t kBodies = kFirstOfFigures + kFigures * kPartsPerFigure;

/// Where the bodies are at one time. A body that has not been placed is not in the scene; the room
/// always is, at the world's origin.
class BodyPoses {
 public:
  BodyPoses() { place(kRoom, glm::dmat4(1)); }

  /// The pose is rigid.
  void place(Body body, const glm::dmat4& worldFromBody) {
    worldFromBody_[body] = worldFromBody;
    isPlaced_[body] = true;
  }
  bool has(Body body) const { return isPlaced_[body]; }
  /// Precondition: has(body).
  const glm::dmat4& operator[](Body body) const { return worldFromBody_[body]; }

 private:
  std::array<glm::dmat4, kBodies> worldFromBody_{};
  std::array<bool, kBodies> isPlaced_{};
};

}  // namespace pleinair::hal::synthetic
