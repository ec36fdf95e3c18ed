// Prints the painter's tables of docs/measured.md as Markdown. `pleinair thesis` has the thesis's
// own table and figures.
// `painter_report fields FOLDER [PICTURE ...]`: the tensor pyramid compared with the global
// radial-basis interpolation; writes error maps into FOLDER; uses the shared data by default.
// `painter_report parts PHOTOGRAPH [WIDTHxHEIGHT [FRAMES]]`: the effect of each part of its
// coherence, on moving images; half an hour at 640x480 and 30 frames.
// `painter_report hidden PHOTOGRAPH ...`: how many strokes of a painting at rest are invisible.
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "firmware_app/thesis/field_comparison.h"
#include "hal/error.h"
#include "hal/media/picture_file.h"
#include "hal/media/png_file.h"
#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/gpu_shaders.h"
#include "pipeline/marks/marks_shaders.h"
#include "pipeline/scene/scene_shaders.h"
#include "pipeline/styles/registry.h"
#include "tests/reports/painter/coherence_parts.h"
#include "tests/reports/painter/hidden_strokes.h"

namespace pleinair {
namespace {

constexpr double kSigmaPx = 8.0;  // for eq. 12: the width of the pyramid's finest regions
constexpr int kRuns = 20;

std::vector<std::filesystem::path> sharedPictures() {
  std::vector<std::filesystem::path> found;
  const std::filesystem::path folder =
      std::filesystem::path(PLEINAIR_SHARED_DATA) / "photos" / "cc0_pd_skimage";
  if (!std::filesystem::exists(folder)) return found;
  for (const auto& each : std::filesystem::directory_iterator(folder)) {
    const std::string extension = each.path().extension().string();
    if (extension == ".png" || extension == ".jpg") found.push_back(each.path());
  }
  std::ranges::sort(found);
  return found;
}

void compareFields(const std::filesystem::path& folder,
                   const std::vector<std::filesystem::path>& pictures) {
  const gpu::EglContext context;
  gpu::ShaderLibrary library;
  library.add(gpu::gpuShaders());
  library.add(gpu::sceneShaders());
  library.add(gpu::marksShaders());
  fmt::print(
      "Tensor pyramid (GPU) beside global radial-basis interpolation (eq. 12, sigma {} px, at the\n"
      "middle of each 8x8 region). Angles in degrees, median / 95 %; where regions have edges of\n"
      "their own, and where both fill in. The pyramid of 2x2 means and eq. 12 on one core.\n\n",
      kSigmaPx);
  fmt::print(
      "| picture | size | edge px | with edges | filled in | pyramid, GPU | 2x2 means, CPU | "
      "eq. 12, CPU |\n|---|---|---|---|---|---|---|---|\n");
  for (const std::filesystem::path& path : pictures) {
    const hal::Image image = hal::orThrow(hal::readPictureRgb(path));
    const app::FieldComparison found = app::compareField(library, image, kSigmaPx, kRuns);
    const auto angle = [&](bool own, double part) {
      return app::degreesAt(found, found.apartRad, own, part);
    };
    fmt::print(
        "| {} | {}x{} | {} | {:.1f} / {:.1f} | {:.1f} / {:.1f} | {:.1f} ms | {:.1f} ms | "
        "{:.0f} ms |\n",
        path.stem().string(), image.size().width, image.size().height, found.edgePixels,
        angle(true, 0.5), angle(true, 0.95), angle(false, 0.5), angle(false, 0.95), found.pyramidMs,
        found.meansMs, found.globalMs);
    std::fflush(stdout);
    const hal::Image map = app::errorMap(found, image);
    hal::orThrow(hal::writePng(folder / (path.stem().string() + "_field_error.png"), map.view()));
  }
}

using Arguments = std::vector<std::string>;

void reportFields(const Arguments& arguments) {
  std::vector<std::filesystem::path> pictures(arguments.begin() + 1, arguments.end());
  compareFields(arguments[0], pictures.empty() ? sharedPictures() : pictures);
}

void reportParts(const Arguments& arguments) {
  hal::FrameSize size{640, 480};
  MeasuredLength length;
  if (arguments.size() > 1) {
    const std::size_t by = arguments[1].find('x');
    if (by == std::string::npos) throw std::invalid_argument("a size is WIDTHxHEIGHT");
    size = {std::stoi(arguments[1]), std::stoi(arguments[1].substr(by + 1))};
  }
  if (arguments.size() > 2) length.frames = std::stoull(arguments[2]);
  printCoherenceParts(arguments[0], size, length);
}

gpu::ShaderLibrary allShaders() {
  gpu::ShaderLibrary library;
  library.add(gpu::gpuShaders());
  library.add(gpu::sceneShaders());
  library.add(gpu::marksShaders());
  styles::addStyleShaders(library);
  return library;
}

void reportHidden(const Arguments& photographs) {
  const gpu::EglContext context;
  const gpu::ShaderLibrary library = allShaders();
  fmt::print(
      "Strokes at rest, 640x480, of each layer from coarse to fine; and the part of them that "
      "later ones hide.\n\n| picture | layers | in all |\n|---|---|---|\n");
  for (const std::string& path : photographs) {
    const auto input = hal::orThrow(measure::openPhotograph(path, {.noiseLevels = 0, .frames = 1}));
    const hal::CapturedFrame frame = *hal::orThrow(input->next());
    LayerUse all;
    std::string layers;
    for (const LayerUse& each : strokesInUse(library, hal::Image(frame.image))) {
      layers += fmt::format("{}{}: {:.0f} %", layers.empty() ? "" : ", ", each.strokes,
                            100.0 * static_cast<double>(each.hidden) /
                                static_cast<double>(std::max<std::size_t>(1, each.strokes)));
      all.strokes += each.strokes;
      all.hidden += each.hidden;
    }
    fmt::print("| {} | {} | {}: {:.1f} % |\n", std::filesystem::path(path).stem().string(), layers,
               all.strokes,
               100.0 * static_cast<double>(all.hidden) / static_cast<double>(all.strokes));
    std::fflush(stdout);
  }
}

struct Section {
  const char* name;
  std::size_t leastArguments;
  std::size_t mostArguments;
  std::function<void(const Arguments&)> report;
  const char* usage;
};

const std::array<Section, 3>& sections() {
  static const std::array<Section, 3> kSections{{
      {"fields", 1, 1000, reportFields, "fields FOLDER [PICTURE ...]"},
      {"parts", 1, 3, reportParts, "parts PHOTOGRAPH [WIDTHxHEIGHT [FRAMES]]"},
      {"hidden", 1, 1000, reportHidden, "hidden PHOTOGRAPH ..."},
  }};
  return kSections;
}

int run(const Arguments& given) {
  const Arguments arguments(given.begin() + (given.empty() ? 0 : 1), given.end());
  for (const Section& each : sections()) {
    if (given.empty() || given[0] != each.name || arguments.size() < each.leastArguments ||
        arguments.size() > each.mostArguments) {
      continue;
    }
    each.report(arguments);
    return 0;
  }
  for (const Section& each : sections()) std::fprintf(stderr, "painter_report %s\n", each.usage);
  return 2;
}

}  // namespace
}  // namespace pleinair

int main(int argc, char** argv) {
  try {
    return pleinair::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "painter_report: %s\n", error.what());
    return 1;
  }
}
