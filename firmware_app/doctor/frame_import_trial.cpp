#include "firmware_app/doctor/frame_import_trial.h"

#include <memory>
#include <utility>

#include <fmt/format.h>

#include "hal/error.h"
#include "hal/frame_memory/allocators.h"
#include "hal/frame_memory/shared_frame.h"
#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/context/shared_displays.h"
#include "pipeline/gpu/frames/camera_frames.h"
#include "pipeline/gpu/frames/imported_texture.h"
#include "pipeline/gpu/programs/shader_library.h"

namespace pleinair::app::doctor {
namespace {

constexpr hal::FrameSize kTriedSize{64, 48};
constexpr hal::Duration kTrialInterval = std::chrono::milliseconds(5);

/// A picture whose every plane tells a shift.
hal::Image gradient() {
  hal::Image picture({.pixelFormat = hal::PixelFormat::kNv12, .size = kTriedSize});
  for (int plane = 0; plane < 2; ++plane) {
    int value = 16;
    for (std::uint8_t& byte : picture.plane(plane)) {
      byte = static_cast<std::uint8_t>(value);
      value = 16 + (value * 7 + 3) % 220;
    }
  }
  return picture;
}

/// Why frames in memory of this kind are uploaded; empty: they are imported.
std::string problemOf(hal::AllocatorKind kind, const gpu::ShaderLibrary& library,
                      const gpu::ContextInfo& context) {
  const auto allocator = hal::openAllocator(kind);
  if (!allocator) return allocator.error().message();
  const hal::Image picture = gradient();
  const auto memory = hal::SharedFrame::make(**allocator, picture.format());
  if (!memory) return memory.error().message();
  (*memory)->write(picture.view());
  const hal::CapturedFrame frame = (*memory)->frame({.pool = hal::nextBufferPool(), .index = 0});
  gpu::CameraFrames frames(library, context);
  hal::SteadyClock clock;
  do {
    frames.show(frame, kTriedSize, gpu::aspectFill(kTriedSize, kTriedSize));
    clock.sleepUntil(clock.now() + kTrialInterval);
  } while (frames.status().path == gpu::FramePath::kTrying);
  return frames.status().path == gpu::FramePath::kImported ? std::string() : frames.status().reason;
}

FrameImportVerdict tried() {
  const gpu::EglContext context;
  std::string problem =
      gpu::planeImportProblem(hal::drmFourcc('R', '8', ' ', ' '), hal::kLinearModifier);
  if (!problem.empty()) return {.reason = std::move(problem)};
  const gpu::ShaderLibrary library;
  for (const hal::AllocatorKind kind : hal::allAllocatorKinds()) {
    const std::string why = problemOf(kind, library, context.info());
    if (why.empty()) return {.isImported = true, .reason = std::string(toString(kind))};
    problem += fmt::format("{}{}: {}", problem.empty() ? "" : "; ", toString(kind), why);
  }
  return {.reason = std::move(problem)};
}

}  // namespace

FrameImportVerdict tryFrameImport() {
  const hal::SteadyClock clock;
  const hal::TimePoint began = clock.now();
  FrameImportVerdict verdict;
  try {
    verdict = tried();
  } catch (const hal::Failure& failure) {
    verdict.reason = failure.error().problem;
  }
  gpu::terminateDisplays();  // a software driver that has a card open may be its master
  verdict.took = clock.now() - began;
  return verdict;
}

}  // namespace pleinair::app::doctor
