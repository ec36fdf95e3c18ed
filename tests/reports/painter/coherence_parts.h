#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "pipeline/engine/painter.h"
#include "pipeline/measure/input/measured_input.h"
#include "pipeline/measure/report/report.h"

namespace pleinair {

/// The painter as it is, with a part of its coherence switched off, or with its dial elsewhere.
struct CoherenceVariant {
  std::string_view name;
  std::string_view parameter;  ///< empty: as it is
  std::string_view value;
};
std::span<const CoherenceVariant> coherenceVariants();

/// How long is measured, in frames. A still of a second and more settles what the past holds.
struct MeasuredLength {
  std::uint64_t frames = 30;
  std::uint64_t settle = 60;
  std::uint64_t stillFrames = 20;
  std::uint64_t stillSettle = 45;
};

using OpenInput = std::function<std::unique_ptr<measure::MeasuredInput>()>;

/// Measures variants of the painter on one input, which is opened anew for each.
class CoherenceParts {
 public:
  /// Throws hal::Failure as Painter does.
  CoherenceParts(OpenInput open, const MeasuredLength& length);

  /// Throws hal::Failure: of the input.
  measure::Report measured(const CoherenceVariant& variant);

 private:
  OpenInput open_;
  MeasuredLength length_;
  std::unique_ptr<Painter> painter_;
};

/// Prints all variants on one photograph that pans, rolls and zooms, and on the workbench, as
/// Markdown. Throws hal::Failure: of the photograph.
void printCoherenceParts(const std::filesystem::path& photograph, hal::FrameSize size,
                         const MeasuredLength& length);

}  // namespace pleinair
