#include "firmware_app/doctor/scan_out_trial.h"

#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "hal/error.h"
#include "hal/outputs/display/trial_surface.h"
#include "hal/surface_pattern.h"
#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/context/shared_displays.h"
#include "pipeline/gpu/frames/import_trial.h"
#include "pipeline/gpu/frames/imported_texture.h"

namespace pleinair::app::doctor {
namespace {

constexpr hal::Duration kPollInterval = std::chrono::milliseconds(5);

hal::Error unsupported(std::string subject, std::string problem) {
  return {.kind = hal::ErrorKind::kUnsupported,
          .subject = std::move(subject),
          .problem = std::move(problem),
          .remedy = {}};
}

/// The layout that was drawn.
hal::Result<std::string> tried(const std::string& target) {
  gpu::ImportSupport support;
  try {
    const gpu::EglContext context;
    support = gpu::importSupport();
  } catch (const hal::Failure& failure) {
    return tl::unexpected(failure.error());
  }
  gpu::terminateDisplays();  // a software driver that has the card open may be its master
  if (support.modifiers.empty()) return tl::unexpected(unsupported("GPU", support.problem));
  auto surface = hal::TrialSurface::make(target, support.modifiers);
  if (!surface) return tl::unexpected(surface.error());
  const hal::GpuSurface drawn = (*surface)->surface();
  gpu::ImportTrial trial(drawn);
  hal::SteadyClock clock;
  std::optional<hal::Result<void>> result = trial.poll();
  for (; !result; result = trial.poll()) clock.sleepUntil(clock.now() + kPollInterval);
  if (!*result) return tl::unexpected(result->error());
  const hal::Result<hal::Image> seen = (*surface)->copy();
  if (!seen) return tl::unexpected(seen.error());
  if (auto same = hal::checkSurfacePattern(seen->view(), drawn.surface.id); !same) {
    return tl::unexpected(same.error());
  }
  return hal::layoutText(drawn.surface.modifier);
}

}  // namespace

ScanOutVerdict tryScanOut(const std::string& target) {
  const hal::SteadyClock clock;
  const hal::TimePoint began = clock.now();
  const hal::Result<std::string> layout = tried(target);
  return {.isDirect = layout.has_value(),
          .reason = layout ? *layout : layout.error().message(),
          .took = clock.now() - began};
}

std::string textOf(const ScanOutVerdict& verdict) {
  return verdict.isDirect
             ? fmt::format("the GPU draws straight into its memory, {} (trial: {:.0f} ms)",
                           verdict.reason, hal::toMilliseconds(verdict.took))
             : fmt::format("pictures are copied: {} (trial: {:.0f} ms)", verdict.reason,
                           hal::toMilliseconds(verdict.took));
}

}  // namespace pleinair::app::doctor
