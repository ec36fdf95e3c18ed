#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "tests/reports/overlay/bench_machine.h"

namespace pleinair::overlay_truth {

inline constexpr hal::Duration kWalkPeriod = std::chrono::milliseconds(50);

/// Where a label lies relative to a point of the machine, from frame to frame.
struct LabelTrack {
  glm::dvec3 point{0.0};              ///< of its centre when it was laid out, in the model's frame
  std::vector<double> x, y;           ///< px from where the point truly is
  std::vector<LabelTrack> completed;  ///< before it was laid out again

  /// px a second of a straight line through it, without the label's whole pixels and the pose's
  /// noise.
  double driftPxPerSecond() const;
};

/// Walks around the bench with the label of a step about four bolts, or one on each of them.
class LabelWalkaround {
 public:
  explicit LabelWalkaround(bool onEach);

  void play(int frames);

  std::vector<LabelTrack> tracks;  ///< by label
  int shown = 0;                   ///< frames with the overlay
  int placed = 0;                  ///< labels, in all frames
  int overlapPx = 0;               ///< of labels over labels
  std::int64_t partPx = 0;         ///< of the parts, in frames with several labels
  std::int64_t coveredPx = 0;      ///< of those by labels

 private:
  struct LabelBox;
  const scene::Model& model() const { return *bench_.scene.models[film_.machine()].model; }
  void countOverlaps(std::span<const LabelBox> boxes);
  void follow(std::size_t index, const overlay::PlacedLabel& label,
              const glm::dmat4& cameraFromModel);

  BenchMachine bench_;
  app::ProcedureFilm film_;
  Painter painter_;
  PaintParameters parameters_;
};

}  // namespace pleinair::overlay_truth
