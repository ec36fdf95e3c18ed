#include "pipeline/scene/description/model_files.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "pipeline/scene/gltf/gltf_fault.h"
#include "pipeline/scene/gltf/gltf_limits.h"
#include "pipeline/scene/gltf/gltf_resources.h"
#include "pipeline/scene/gltf/gltf_structure.h"
#include "pipeline/scene/meshes/mesh_file.h"

namespace pleinair::scene {
namespace {

namespace fs = std::filesystem;

fs::path folderOf(const fs::path& model) {
  return model.parent_path().empty() ? fs::path(".") : model.parent_path();
}

void addGltfFiles(const std::vector<std::uint8_t>& bytes, const fs::path& model,
                  std::vector<fs::path>& files) {
  const gltf::Structure structure = gltf::readStructure(gltf::openContainer(bytes).json);
  const auto add = [&](const std::optional<std::string>& uri) {
    if (!uri || uri->starts_with("data:")) return;
    try {
      files.push_back(gltf::fileOf(*uri, folderOf(model), ""));
    } catch (const gltf::Fault&) {
      return;  // nothing that is shown needs it, or the model would not have been read
    }
  };
  for (const gltf::BufferEntry& each : structure.buffers) add(each.uri);
  for (const gltf::ImageEntry& each : structure.images) add(each.uri);
}

/// Of "mtllib NAME" lines. A name may have spaces; several names may stand in a line.
void addMaterialLibraries(std::string_view text, const fs::path& model,
                          std::vector<fs::path>& files) {
  constexpr std::string_view kKeyword = "mtllib";
  const auto addIfThere = [&](std::string_view name) {
    std::error_code failure;
    const fs::path file = fs::canonical(folderOf(model) / std::string(name), failure);
    if (failure || name.empty() || !fs::is_regular_file(file, failure)) return false;
    const fs::path within = file.lexically_relative(fs::canonical(folderOf(model), failure));
    if (within.empty() || *within.begin() == "..") return false;
    files.push_back(file);
    return true;
  };
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    at = end + 1;
    if (!line.starts_with(kKeyword)) continue;
    line.remove_prefix(kKeyword.size());
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == 0 || first == std::string_view::npos) continue;
    line = line.substr(first, line.find_last_not_of(" \t\r") + 1 - first);
    if (addIfThere(line)) continue;
    for (std::size_t word = 0; word < line.size();) {
      const std::size_t wordEnd = std::min(line.find_first_of(" \t", word), line.size());
      addIfThere(line.substr(word, wordEnd - word));
      word = wordEnd + 1;
    }
  }
}

}  // namespace

hal::Result<std::vector<fs::path>> filesBeside(const fs::path& model) {
  std::vector<fs::path> files;
  try {
    const std::vector<std::uint8_t> bytes = gltf::readWholeFile(model, gltf::kMaxFileBytes, "");
    if (!isMeshFile(model)) {
      addGltfFiles(bytes, model, files);
    } else if (hasMaterials(model)) {
      addMaterialLibraries({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, model,
                           files);
    }
  } catch (const gltf::Fault& fault) {
    return tl::unexpected(hal::Error{.kind = fault.kind(),
                                     .subject = model.string(),
                                     .problem = gltf::oneLine(fault.what()),
                                     .remedy = fault.remedy()});
  }
  std::ranges::sort(files);
  const auto repeated = std::ranges::unique(files);
  files.erase(repeated.begin(), repeated.end());
  return files;
}

}  // namespace pleinair::scene
