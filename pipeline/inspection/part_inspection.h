#pragma once

#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "pipeline/inspection/part_window.h"
#include "pipeline/inspection/structure_match.h"

namespace pleinair::inspection {

/// What the comparison of a still with a template says. Uncertain is an answer: a wrong "pass" is
/// worse than a question.
enum class Verdict { kPass, kFail, kUncertain };

/// Why a comparison is uncertain.
enum class Uncertainty {
  kNone,
  kOtherSide,  ///< taken from another side than the template
  kNotWholly,  ///< a piece of the part is beside the picture
  kTooFar,
  kNothingToCompare,  ///< the template shows no structure
  kTooDark,
  kAlmostAlike  ///< between pass and fail
};

struct Inspection {
  Verdict verdict = Verdict::kUncertain;
  Uncertainty reason = Uncertainty::kNone;  ///< of kUncertain
  double viewDeg = 0.0;  ///< between the places of both cameras, as the part sees them
  std::optional<StructureMatch> match;  ///< nothing where nothing could be compared
};

/// Where verdicts change; decision 0065 says how they were chosen.
inline constexpr double kPassMean = 0.84;
inline constexpr double kPassWorst = 0.70;
inline constexpr double kFailMean = 0.72;
inline constexpr double kFailWorst = 0.40;

/// The verdict of a match alone.
Verdict verdictOf(const StructureMatch& match);

/// What is inspected: parts of a machine, in its frame.
struct InspectedPart {
  glm::dvec3 centre{0.0};  ///< of a sphere around them
  double radiusMetres = 0.0;
  /// Their surface: only edges there count. Empty: all edges in the sphere.
  std::span<const PartTriangle> triangles;
};

/// Compares a still with a template about a part. Uncertain where
/// the still was taken from another side, from too far, shows only a piece of the part, or is dark.
Inspection inspectPart(const PosedPicture& templatePicture, const PosedPicture& still,
                       const InspectedPart& part);

}  // namespace pleinair::inspection
