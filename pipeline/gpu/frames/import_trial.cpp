#include "pipeline/gpu/frames/import_trial.h"

#include <cstdint>
#include <cstdio>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/frames/imported_texture.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/render_target.h"

namespace pleinair::gpu {
namespace {

constexpr const char* kArgument = "--draw-pattern";
constexpr std::size_t kFixed = 6;  ///< numbers that all surfaces have
constexpr std::size_t kPerPlane = 2;

/// A surface as arguments: its number, size, fourcc, modifier, planes; then offset and stride each.
std::vector<std::string> argumentsOf(const hal::GpuSurface& of) {
  const hal::Surface& surface = of.surface;
  std::vector<std::string> arguments{"pleinair",
                                     kArgument,
                                     std::to_string(static_cast<std::uint32_t>(surface.id)),
                                     std::to_string(of.bufferSize.width),
                                     std::to_string(of.bufferSize.height),
                                     std::to_string(surface.fourcc),
                                     std::to_string(surface.modifier),
                                     std::to_string(surface.planeCount)};
  for (int i = 0; i < surface.planeCount; ++i) {
    const hal::SurfacePlane& plane = surface.planes.at(static_cast<std::size_t>(i));
    arguments.push_back(std::to_string(plane.offsetBytes));
    arguments.push_back(std::to_string(plane.strideBytes));
  }
  return arguments;
}

/// The surface of argumentsOf(), with the descriptors that a trial passes on.
std::optional<hal::GpuSurface> surfaceOf(int argc, const char* const* argv) {
  const auto given = TrialProcess::numbersOf(argc, argv);
  if (!given) return std::nullopt;
  const std::vector<std::uint64_t>& numbers = *given;
  if (numbers.size() < kFixed || numbers[5] < 1 || numbers[5] > 4 ||
      numbers.size() != kFixed + numbers[5] * kPerPlane) {
    return std::nullopt;
  }
  hal::GpuSurface surface{
      .bufferSize = {static_cast<int>(numbers[1]), static_cast<int>(numbers[2])}};
  surface.surface.id = hal::SurfaceId{static_cast<std::uint32_t>(numbers[0])};
  surface.surface.fourcc = static_cast<std::uint32_t>(numbers[3]);
  surface.surface.modifier = numbers[4];
  surface.surface.planeCount = static_cast<int>(numbers[5]);
  for (std::size_t i = 0; i < numbers[5]; ++i) {
    surface.surface.planes.at(i) = {
        .dmaBuf = TrialProcess::kFirstDescriptor + static_cast<int>(i),
        .offsetBytes = static_cast<std::size_t>(numbers[kFixed + i * kPerPlane]),
        .strideBytes = static_cast<std::size_t>(numbers[kFixed + i * kPerPlane + 1])};
  }
  return surface;
}

std::vector<int> descriptorsOf(const hal::Surface& surface) {
  std::vector<int> descriptors;
  for (int i = 0; i < surface.planeCount; ++i) {
    descriptors.push_back(surface.planes.at(static_cast<std::size_t>(i)).dmaBuf);
  }
  return descriptors;
}

}  // namespace

ImportTrial::ImportTrial(const hal::GpuSurface& surface, const hal::Clock& clock)
    : process_(argumentsOf(surface), descriptorsOf(surface.surface),
               "draw into the display's memory", clock) {}

std::optional<hal::Result<void>> ImportTrial::poll() {
  const std::optional<hal::Result<int>> ended = process_.poll();
  if (!ended) return std::nullopt;
  if (!*ended) return tl::unexpected(ended->error());
  if (**ended == 0) return hal::Result<void>();
  return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kUnsupported,
                                   .subject = "GPU",
                                   .problem = "cannot draw into the display's memory",
                                   .remedy = {}});
}

std::optional<int> runImportTrial(int argc, const char* const* argv) {
  if (argc < 2 || std::string_view(argv[1]) != kArgument) return std::nullopt;
  const std::optional<hal::GpuSurface> surface = surfaceOf(argc, argv);
  if (!surface) return 2;
  try {
    const EglContext context;
    ShaderLibrary library;
    Program pattern = library.fragmentPass("pipeline/gpu/shaders/surface_pattern.frag");
    const Texture texture = importedTexture(*surface);
    const RenderTarget target({&texture});
    target.beginDiscarding();
    pattern.use().set("surface", static_cast<int>(surface->surface.id));
    pattern.drawArea(target, {0, 0}, target.size());
    hal::orThrow(Fence::insert().wait());
    return 0;
  } catch (const hal::Failure& failure) {
    std::fprintf(stderr, "pleinair: %s\n", failure.what());
    return 1;
  }
}

}  // namespace pleinair::gpu
