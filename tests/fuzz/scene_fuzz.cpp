// Parses text as a scene file and as a calibration, and runs the computations before the first
// frame.
#include "config/toml_reader.h"
#include "pipeline/scene/description/scene_file.h"
#include "pipeline/tracking/camera/calibration_file.h"
#include "tests/fuzz/config_errors.h"

namespace {

using namespace pleinair;

/// A missing folder, so that no file is opened beside the scene.
constexpr const char* kFolder = "/nonexistent";

/// Maps the corners and the middle to rays, and back.
void look(const tracking::CameraModel& camera) {
  const glm::dvec2 size(camera.imageSize().width, camera.imageSize().height);
  for (const glm::dvec2 at : {glm::dvec2(0.0), glm::dvec2(0.5), glm::dvec2(1.0)}) {
    const std::optional<glm::dvec3> ray = camera.unproject(at * size);
    if (ray && ray->z != 1.0) fuzz::fail("a ray that is no (x, y, 1)");
    if (ray) camera.project(*ray);
  }
  scene::fittedCamera(camera, {640, 480});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::asText(data, size);
  fuzz::expectConfigErrors([&] {
    const scene::Scene scene = scene::parseScene(text, "scene.toml", kFolder);
    if (scene.camera) look(*scene.camera);
    for (const scene::SceneModel& model : scene.models) {
      if (model.model == nullptr) fuzz::fail("a model without a surface");
    }
  });
  fuzz::expectConfigErrors([&] {
    const auto document = config::TomlDocument::parseText(text, "camera.toml");
    look(tracking::readCalibration(document.root()));
  });
  return 0;
}
