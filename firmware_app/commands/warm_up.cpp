#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "firmware_app/cli/exit_status.h"
#include "firmware_app/cli/interrupt.h"
#include "firmware_app/cli/standard_streams.h"
#include "firmware_app/commands/commands.h"
#include "firmware_app/config/configured_parts.h"
#include "firmware_app/scene/workbench_scene.h"
#include "hal/cameras/synthetic/synthetic_camera.h"
#include "pipeline/engine/painter.h"
#include "pipeline/gpu/context/shared_displays.h"
#include "pipeline/scene/description/scene_file.h"
#include "pipeline/styles/registry.h"

namespace pleinair::app {
namespace {

using hal::orThrow;
using hal::PixelFormat;

/// Size of the film that shaders are compiled with, where none is configured.
constexpr hal::FrameSize kFilmSize{640, 480};
/// Enough for what compares a frame with the ones before.
constexpr int kFramesOfALook = 3;

/// A program that Mesa reads back from its cache is not always the one that it put there, so that
/// the second start compiles again what it then finds: 79 files after the first, 90 after the
/// second and all later ones (llvmpipe of Mesa 22.3, a photograph in watercolor).
constexpr int kPasses = 2;

/// Layouts of cameras, each with a program of its own.
constexpr std::array kCameraLayouts{PixelFormat::kGrey8, PixelFormat::kRgb8,
                                    PixelFormat::kYuyv,  PixelFormat::kNv12,
                                    PixelFormat::kI420,  PixelFormat::kBayerRggb8};
/// Layouts of outputs.
constexpr std::array kOutputLayouts{PixelFormat::kRgba8, PixelFormat::kRgb8, PixelFormat::kI420,
                                    PixelFormat::kNv12, PixelFormat::kYuyv};

/// The film that is painted: the workbench with people, and models on its tags.
struct Film {
  scene::Scene scene;
  std::vector<hal::CapturedFrame> frames;
};

Film makeFilm(hal::FrameSize size) {
  hal::SteppedClock clock;
  hal::SyntheticCamera camera({.size = size, .shot = hal::SyntheticShot::kVisitors}, clock);
  orThrow(camera.start({}));
  Film film{.scene = scene::parseScene(workbenchScene(camera.truth(0), size), "workbench", {}),
            .frames = {}};
  for (int i = 0; i < kFramesOfALook; ++i) {
    hal::NextFrame next = camera.next(hal::kNoDeadline);
    film.frames.push_back(std::get<hal::CapturedFrame>(std::move(next)));
  }
  return film;
}

bool isInterrupted() {
  return Interrupt::received() != 0;
}

std::vector<config::ParameterValues> parametersOfLooks(const styles::StyleKind& kind) {
  std::vector<config::ParameterValues> looks;
  for (const styles::Look& look : kind.looks) looks.push_back(kind.parametersOf(look.name));
  if (looks.empty()) looks.push_back(kind.defaults);
  return looks;
}

/// Paints what the style's programs are for, so that the driver compiles and keeps them.
void warmUp(const styles::StyleKind& kind, const scene::Scene& scene, const Film& film) {
  const hal::FrameFormat format = film.frames.front().image.format;
  Painter painter({.pictureSize = format.size,
                   .scene = scene,
                   .style = std::string(kind.name),
                   .expectedFormat = format,
                   .qualityLevels = true,
                   .isCancelled = isInterrupted});
  for (const PixelFormat layout : kOutputLayouts) {
    painter.openReadback({.pixelFormat = layout, .size = format.size});
  }
  PaintParameters parameters = painter.defaultParameters();
  const auto paintFilm = [&] {
    painter.reset();
    for (const hal::CapturedFrame& frame : film.frames) {
      if (!isInterrupted()) orThrow(painter.paint(frame, parameters));
    }
  };
  for (const config::ParameterValues& look : parametersOfLooks(kind)) {
    parameters.style = look;
    paintFilm();
  }
  parameters.style = kind.defaults;
  for (parameters.quality = 1; parameters.quality < qualityLevels().size(); ++parameters.quality) {
    paintFilm();
  }
  parameters.quality = 0;
  for (const PixelFormat layout : kCameraLayouts) {
    const hal::Image blank({.pixelFormat = layout, .size = format.size});
    if (!isInterrupted()) orThrow(painter.paint({.image = blank.view()}, parameters));
  }
  // Debug views, which are changed to live.
  for (const DebugView& view : painter.views()) {
    parameters.view = view.name;
    if (!isInterrupted()) orThrow(painter.paint(film.frames.back(), parameters));
  }
}

std::vector<const styles::StyleKind*> stylesToWarm(const std::vector<std::string>& names) {
  std::vector<const styles::StyleKind*> chosen;
  for (const std::string& name : names) chosen.push_back(&styles::styleKind(name));
  const auto all = styles::styleKinds();
  if (names.empty()) chosen.assign(all.begin(), all.end());
  return chosen;
}

}  // namespace

int warmUpShaders(const WarmUpOptions& options) {
  const Interrupt interrupt;
  const Configuration configuration(options.configuration);
  return configuration.attributing([&] {
    const std::vector<const styles::StyleKind*> kinds = stylesToWarm(options.styles);
    const scene::Scene configured = configuredScene(configuration);
    const hal::FrameSize size = configuredPainting(configuration, {}).size.value_or(kFilmSize);
    const Film film = makeFilm(size);
    // A calibration of another size than the film's would refuse its frames.
    scene::Scene models = configured;
    models.camera.reset();
    for (const styles::StyleKind* kind : kinds) {
      const auto began = std::chrono::steady_clock::now();
      try {
        for (int pass = 0; pass < kPasses; ++pass) {
          warmUp(*kind, film.scene, film);
          // Without models, passes are left out and others read what is not there.
          warmUp(*kind, {}, film);
          if (!models.models.empty()) warmUp(*kind, models, film);
          gpu::terminateDisplays();
        }
      } catch (const hal::Failure& failure) {
        if (failure.error().kind != hal::ErrorKind::kCancelled) throw;
      }
      if (const int signal = Interrupt::received(); signal != 0) {
        printError(
            fmt::format("interrupted by {}; the programs so far are kept", signalName(signal)));
        return kSignalExitBase + signal;
      }
      const std::chrono::duration<double> time = std::chrono::steady_clock::now() - began;
      writeText(stdout, fmt::format("{}: {:.1f} s\n", kind->name, time.count()));
      std::fflush(stdout);  // the next style takes a while
    }
    return 0;
  });
}

}  // namespace pleinair::app
