#pragma once

#include <span>
#include <string_view>

namespace pleinair::styles {

/// A measure of coherence (docs/measuring.md), as pipeline/measure takes it.
enum class CoherenceMeasure { kEw2, kXEw2, kNHw2, kPop, kS10, kScr, kXFlk, kDep, kDet };

/// The motions under which a gate is judged.
enum class GateMotion {
  kAny,
  kPan,         ///< one vector, which may be zero; not measured where no motion is known
  kOtherKnown,  ///< motion that one global translation would not pass
  kMoving,      ///< known or not
};

/// A limit that a style's paintings keep to.
struct CoherenceGate {
  CoherenceMeasure measure = CoherenceMeasure::kNHw2;
  enum class Side { kMax, kMin } side = Side::kMax;
  double limit = 0.0;
  /// The limit is a share of what tiles fixed to the screen read on the same frames.
  bool isOfTiling = false;
  GateMotion motion = GateMotion::kAny;
};

/// All that a style promises of its coherence; nothing where it promises nothing.
struct CoherenceGates {
  std::span<const CoherenceGate> gates = {};
  /// Whether its anchors must neither be born nor die for no reason.
  bool holdsAnchors = false;
  /// Looks on bare paper, which show little of the colours of things.
  std::span<const std::string_view> paperLooks = {};
  /// Thin lines: an exact motion by a part of a pixel changes them clearly.
  bool drawsLines = false;

  bool empty() const { return gates.empty(); }
};

}  // namespace pleinair::styles
