#include "firmware_app/scene/workbench_scene.h"

#include <utility>

#include <fmt/format.h>
#include <glm/mat4x4.hpp>

#include "firmware_app/scene/attach_rotation.h"
#include "hal/pending_file.h"
#include "pipeline/scene/description/scene.h"

namespace pleinair::app {
namespace {

/// A machine on the tag with free space on the bench, and gears on other flat tags.
constexpr const char* kModels = R"(
[[model]]
name = "gearbox"
source = "builtin:gearbox"
attach = "tag:0"
length_m = 0.26
rotation_deg = [0, 0, 12]

[[model]]
name = "pinion"
source = "builtin:gear"
attach = "tag:4"
teeth = 12
module_m = 0.006
thickness_m = 0.03
colour = "#3f8fb5"
)";

std::string tagTable(const hal::BenchTag& tag) {
  const glm::dmat4 worldFromAttach = tag.worldFromTag * scene::kTagFromAttach;
  const glm::dvec3 rotation = rotationDegrees(worldFromAttach);
  const glm::dvec3 position(worldFromAttach[3]);
  return fmt::format(
      "\n[[tag]]\nfamily = \"{}\"\nid = {}\nedge_m = {}\n"
      "position_m = [{:.6f}, {:.6f}, {:.6f}]\nrotation_deg = [{:.6f}, {:.6f}, {:.6f}]\n",
      tag.family, tag.id, tag.edgeMetres, position.x, position.y, position.z, rotation.x,
      rotation.y, rotation.z);
}

}  // namespace

std::string workbenchSetting(const hal::GroundTruth& truth, hal::FrameSize size) {
  std::string text = fmt::format(
      "# The synthetic camera and its workbench.\n[camera]\nimage_size = [{}, {}]\n"
      "fx = {:.6f}\nfy = {:.6f}\ncx = {:.6f}\ncy = {:.6f}\npixel_centres = \"half\"\n",
      size.width, size.height, truth.intrinsics.fx, truth.intrinsics.fy, truth.intrinsics.cx,
      truth.intrinsics.cy);
  for (const hal::TagTruth& tag : truth.tags) text += tagTable(tag.tag);
  return text;
}

std::string workbenchScene(const hal::GroundTruth& truth, hal::FrameSize size) {
  return workbenchSetting(truth, size) + kModels;
}

hal::Result<void> writeWorkbenchScene(const std::filesystem::path& path,
                                      const hal::GroundTruth& truth, hal::FrameSize size) {
  auto file = hal::PendingFile::create(path);
  if (!file) return tl::unexpected(std::move(file.error()));
  const std::string text = workbenchScene(truth, size);
  const auto written =
      file->write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return written ? file->publish() : written;
}

}  // namespace pleinair::app
