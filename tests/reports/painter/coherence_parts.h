#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "pipeline/engine/painter.h"
#include "pipeline/measure/input/measured_input.h"
#include "pipeline/measure/measurement_report.h"

namespace pleinair {

/// The painter with one part of its coherence switched off, or with one parameter changed.
struct CoherenceVariant {
  std::string_view name;
  std::string_view parameter;  ///< empty: unchanged
  std::string_view value;
};
std::span<const CoherenceVariant> coherenceVariants();

/// The measured length, in frames. A second or more of a static image settles the past.
struct MeasuredLength {
  std::uint64_t frames = 30;
  std::uint64_t settle = 60;
  std::uint64_t stillFrames = 20;
  std::uint64_t stillSettle = 45;
};

using OpenInput = std::function<std::unique_ptr<measure::MeasuredInput>()>;

/// Measures variants of the painter on one input, which is reopened for each.
class CoherenceParts {
 public:
  /// Throws hal::Failure like Painter.
  CoherenceParts(OpenInput open, const MeasuredLength& length);

  /// Throws hal::Failure if the input fails.
  measure::Report measured(const CoherenceVariant& variant);

 private:
  OpenInput open_;
  MeasuredLength length_;
  std::unique_ptr<Painter> painter_;
};

/// Prints all variants as Markdown, on a photograph that pans, rolls and zooms, and on the
/// workbench. Throws hal::Failure for the photograph.
void printCoherenceParts(const std::filesystem::path& photograph, hal::FrameSize size,
                         const MeasuredLength& length);

}  // namespace pleinair
