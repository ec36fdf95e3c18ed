#pragma once

#include <optional>
#include <string>

#include <glm/vec3.hpp>

#include "pipeline/inspection/part_window.h"
#include "pipeline/inspection/structure_match.h"

namespace pleinair::inspection {

/// What the comparison of a still with a template says. Uncertain is an answer: a wrong "pass" is
/// worse than a question.
enum class Verdict { kPass, kFail, kUncertain };

struct Inspection {
  Verdict verdict = Verdict::kUncertain;
  std::string reason;                   ///< of kUncertain, what would help: "come closer"
  std::optional<StructureMatch> match;  ///< nothing where nothing could be compared
};

/// Where verdicts change; decision 0065 says how they were chosen.
inline constexpr double kPassMean = 0.90;
inline constexpr double kPassWorst = 0.40;
inline constexpr double kFailMean = 0.84;
inline constexpr double kFailWorst = 0.30;

/// The verdict of a match alone.
Verdict verdictOf(const StructureMatch& match);

/// Compares a still with a template about a part: a sphere in the machine's frame. Uncertain where
/// the still was taken from another side, from too far, shows only a piece of the part, or is dark.
Inspection inspectPart(const PosedPicture& templatePicture, const PosedPicture& still,
                       const glm::dvec3& centre, double radiusMetres);

}  // namespace pleinair::inspection
